"""Classical mechanics at native speed."""

from visviva.errors import CloseEncounter, ConvergenceError, Error, InternalError, Interrupted, InvalidInput

__version__ = "0.1.0"

__all__ = ["CloseEncounter", "ConvergenceError", "Error", "InternalError", "Interrupted", "InvalidInput"]
