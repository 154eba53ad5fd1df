"""Measured and published data, each with its source."""

from typing import TYPE_CHECKING

from visviva._keywords import unknown_name
from visviva.datasets.geiger_marsden import GeigerMarsden, RutherfordComparison, geiger_marsden_1913
from visviva.datasets.outer_solar_system import OuterSolarSystem, outer_solar_system
from visviva.datasets.solar_system import SolarSystem, solar_system
from visviva.datasets.toutatis import RadarAttitudes, Toutatis, ToutatisComparison, toutatis

__all__ = [
    "GeigerMarsden",
    "OuterSolarSystem",
    "RadarAttitudes",
    "RutherfordComparison",
    "SolarSystem",
    "Toutatis",
    "ToutatisComparison",
    "geiger_marsden_1913",
    "outer_solar_system",
    "solar_system",
    "toutatis",
]


def __dir__() -> list[str]:
    return list(__all__)


if not TYPE_CHECKING:
    __getattr__ = unknown_name(__name__, __all__)
