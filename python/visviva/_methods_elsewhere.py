"""Methods of other packages.

The one idea: whoever asks for one by the name that it has elsewhere is told what does here what it is for.
"""

from visviva.errors import InvalidInput

# What is called so elsewhere, and what does here what it is for.
_EXACT = "for digits that leave nothing, 'taylor' or 'verner98' with rtol=1e-13"
_PLANETS = "for planets and many turns, 'kahan_li8' or 'stormer13' with dt"
_ENCOUNTERS = "'verner98' takes smaller steps through encounters, and 'kahan_li8' keeps energies between them"
_STIFF = "it is implicit, which scipy.integrate.solve_ivp has for stiff equations and visviva has not"
OF_OTHERS = {
    "ias15": _EXACT,
    "bs": _EXACT,
    "gbs": _EXACT,
    "whfast": _PLANETS,
    "wisdom_holman": _PLANETS,
    "janus": "for a way back that is the way there up to rounding, 'kahan_li8' with dt, which is symmetric",
    "saba": _PLANETS,
    "eos": _PLANETS,
    "mercurius": _ENCOUNTERS,
    "trace": _ENCOUNTERS,
    "rk45": "'dormand_prince54' is that pair",
    "rk23": "'bogacki_shampine32' is that pair",
    "verlet": "'leapfrog' is that method",
    "velocity_verlet": "'leapfrog' is that method",
    "stormer_verlet": "'leapfrog' is that method",
    "lsoda": _STIFF,
    "radau": _STIFF,
    "bdf": _STIFF,
}


def refuse_of_others(name: str, value: str, *, stiff: str = _STIFF) -> None:
    """Refuse a method of another package with what does here what it is for; `stiff` of implicit ones.

    Of any other name it says nothing.

    Raises
    ------
    InvalidInput
        Naming the argument.
    """
    if (cure := OF_OTHERS.get(value.lower().replace("-", "_").replace(" ", "_"))) is not None:
        raise InvalidInput(name, f"{value} is none of visviva.methods(); {stiff if cure is _STIFF else cure}")
