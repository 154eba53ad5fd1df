"""What every test shares."""

from hypothesis import settings

# The same examples every time: a failure on another machine can be repeated. `--hypothesis-seed=random` with
# `--hypothesis-profile=search` looks further.
settings.register_profile("same", derandomize=True, deadline=None)
settings.register_profile("search", max_examples=1000, deadline=None)
settings.load_profile("same")
