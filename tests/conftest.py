"""What every test shares."""

import signal

from hypothesis import settings

# A shell that starts the tests in the background has Ctrl-C ignored by them and all that they start.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# The same examples every time: a failure on another machine can be repeated. `--hypothesis-seed=random` with
# `--hypothesis-profile=search` looks further.
settings.register_profile("same", derandomize=True, deadline=None)
settings.register_profile("search", max_examples=1000, deadline=None)
settings.load_profile("same")
