#!/usr/bin/env bash
# vendored_sdist.sh FOLDER: the sources with every crate that they need, so that they build without a network.
# What is committed is copied first: nothing changes here.
set -euo pipefail
mkdir -p "$1"
out=$(cd "$1" && pwd)
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
git archive HEAD | tar -x -C "$work"
cd "$work"
cargo vendor --locked --versioned-dirs vendor > vendored.toml
printf '\n' >> .cargo/config.toml
cat vendored.toml >> .cargo/config.toml
rm vendored.toml
maturin sdist --out "$out"
