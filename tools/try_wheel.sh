#!/usr/bin/env bash
# try_wheel.sh FOLDER: install the wheel of a folder into an environment of its own, use it from elsewhere as a stranger
# would, and see that neither the SIMD tier nor the number of threads changes a bit.
set -euo pipefail
wheels=$(cd "$1" && pwd)
script=$(cd "$(dirname "$0")" && pwd)/use_wheel.py
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python -m venv "$work/venv"
bin=$work/venv/bin
if [ -d "$work/venv/Scripts" ]; then bin=$work/venv/Scripts; fi
"$bin/python" -m pip install -q "$wheels"/visviva-*.whl
cp "$script" "$work/"
cd "$work"
"$bin/python" -m visviva info
best=$("$bin/python" use_wheel.py)
portable=$(VISVIVA_SIMD=portable VISVIVA_THREADS=1 "$bin/python" use_wheel.py)
printf 'best tier %s\nportable  %s\n' "$best" "$portable"
if [ "$best" != "$portable" ]; then echo "the SIMD tier or the number of threads changed a bit" >&2; exit 1; fi
