"""Attributes that people look for in scenes, runs, bodies and potentials, and what they are here.

The one idea: what has the thing under another name says which; other names are refused as Python does.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

__all__ = [
    "OF_BODIES",
    "OF_DEFLECTIONS",
    "OF_PARTICLES",
    "OF_POTENTIALS",
    "OF_RUNS",
    "OF_SCENES",
    "OF_SOLIDS",
    "OF_SYSTEMS",
    "OF_TABLES",
    "OF_TOPS",
    "no_attribute",
]

#: Attributes of a scene.
OF_SCENES = {
    "integrate": "a scene runs to a time, and stays what it is: out = scene.run(t=…); out.final is the scene there",
    "solve": "a scene runs to a time: scene.run(t=…)",
    "simulate": "a scene runs to a time: scene.run(t=…)",
    "step": "a scene runs to a time: scene.run(t=…)",
    "add": "parts do not change: make a new Scene of more particles, and of particles and forces",
    "move_to_com": "it is center_of_mass_frame()",
    "orbits": "it is elements(about=…)",
    "energy": "it is invariants().energy",
    "angular_momentum": "it is invariants().angular_momentum",
    "lyapunov_exponents": "the largest is megno(t=…).lyapunov_exponent; a Lagrangian has all",
    "init_megno": "it is megno(t=…)",
    "add_variation": "it is flow_jacobian(t=…)",
    "state_transition_matrix": "it is flow_jacobian(t=…)",
    "t": "it is t0; run(t=…) takes the end",
    "dt": "it is an argument of run",
    "add_force": "parts do not change: make a new Scene, visviva.Scene(scene.particles, *scene.forces, another)",
    "momentum": "it is invariants().momentum",
    "kinetic_energy": "it is invariants().kinetic_energy",
    "potential_energy": "it is invariants().potential_energy",
    "center_of_mass": "it is particles.center_of_mass()",
    "G": "it is that of the force: forces[0].G",
    "time": "it is t0; run(t=…) takes the end",
    "bodies": "it is particles, and rigid_bodies",
    "names": "it is particles.names",
    "masses": "it is particles.mass",
    "n": "it is len(scene.particles)",
    "N": "it is len(scene.particles)",
    "copy": "a scene does not change, so it needs no copy; with_state makes another one",
    "save": "a run is saved: scene.run(t=…).save(path), and its final is the scene to go on with",
    "position": "it is particles.position",
    "velocity": "it is particles.velocity",
    "mass": "it is particles.mass",
    "plot": "a run has pictures: scene.run(t=…).plot()",
    "animate": "a run has pictures: scene.run(t=…).animate(…)",
}

_BETWEEN = "position and velocity at the times asked for as t: outputs between steps cost little and change no step"

#: Attributes of a run: what it is.
OF_RUNS = {
    "y": "position and velocity",
    "sol": _BETWEEN,
    "at": _BETWEEN,
    "interpolate": _BETWEEN,
    "method": "plan.method",
    "positions": "position",
    "velocities": "velocity",
    "acceleration": "final.acceleration() where a run of a scene ends",
    "success": "status == vv.Status.OK",
    "message": "status",
    "nfev": "stats.evaluations",
    "nsteps": "stats.steps",
    "x": "position",
    "r": "position",
    "pos": "position",
    "v": "velocity",
    "times": "t",
    "time": "t",
    "L": "angular_momentum",
    "p": "momentum",
    "kinetic": "kinetic_energy",
    "T": "kinetic_energy",
    "E": "energy",
    "V": "potential_energy",
    "U": "potential_energy",
    "potential": "potential_energy",
    "omega": "angular_velocity",
    "quaternion": "orientation, (x, y, z, w)",
    "rotation": "vv.rigid.matrix(out.orientation)",
    "euler_angles": "vv.rigid.euler_angles(out.orientation, …)",
    "w": "angular_velocity",
    "quaternions": "orientation, (x, y, z, w)",
    "orientations": "orientation",
    "angular_velocities": "angular_velocity",
    "R": "vv.rigid.matrix(out.orientation)",
    "rotation_matrix": "vv.rigid.matrix(out.orientation)",
    "euler": "vv.rigid.euler_angles(out.orientation, …)",
    "total_energy": "energy",
    "momenta": "momentum",
    "energy_error": "conservation()",
    "eccentricity": "elements(body, about=…).eccentricity",
    "semi_major_axis": "elements(body, about=…).semi_major_axis",
    "orbits": "elements(body, about=…)",
    "steps": "stats.steps",
    "state": "position and velocity",
    "states": "position and velocity",
    "particles": "final.particles where a run of a scene ends, position and velocity on the way",
    "dataframe": "to_pandas()",
    "df": "to_pandas()",
    "to_csv": "to_pandas().to_csv(path)",
    "final_state": "final, to go on from",
    "y_events": "events.position and events.velocity",
    "t_events": "events.t, of one event events.of(which).t",
    "distance": "np.linalg.norm(out.position[:, 0] - out.position[:, 1], axis=-1)",
}

#: Attributes of a table of events.
OF_TABLES = {
    "time": "t",
    "times": "t",
    "x": "position",
    "y": "position and velocity",
    "v": "velocity",
    "event": "which",
    "kind": "definitions[which].kind",
    "body": "definitions, each with the bodies that it looks at",
    "copy": "member",
}

_OF_A_SCENE = "known of a scene: visviva.Scene(…).invariants()"

#: Attributes of particles.
OF_PARTICLES = {
    "x": "position, of shape (N, 3): position[:, 0]",
    "y": "position, of shape (N, 3): position[:, 1]",
    "z": "position, of shape (N, 3): position[:, 2]",
    "r": "position",
    "pos": "position",
    "positions": "position",
    "v": "velocity",
    "vel": "velocity",
    "velocities": "velocity",
    "m": "mass",
    "masses": "mass",
    "n": "len(particles)",
    "N": "len(particles)",
    "name": "names",
    "com": "center_of_mass()",
    "energy": _OF_A_SCENE,
    "kinetic_energy": _OF_A_SCENE,
    "momentum": _OF_A_SCENE,
    "angular_momentum": _OF_A_SCENE,
}

#: Attributes of rigid bodies.
OF_BODIES = {
    "omega": "angular_velocity",
    "w": "angular_velocity",
    "quaternion": "orientation, (x, y, z, w)",
    "q": "orientation, (x, y, z, w)",
    "tensor": "inertia, or moments",
    "inertia_tensor": "inertia, or moments",
    "I": "inertia, or moments",
    "moments_of_inertia": "moments",
    "principal_axes": "axes",
    "name": "names",
    "energy": _OF_A_SCENE,
    "kinetic_energy": _OF_A_SCENE,
    "angular_momentum": _OF_A_SCENE,
    "run": "a scene that runs: visviva.Scene(body).run(t=…)",
}

#: Attributes of solids.
OF_SOLIDS = {
    "inertia": "tensor",
    "I": "tensor",
    "inertia_tensor": "tensor",
    "moments": "principal_axes().moments",
    "principal_moments": "principal_axes().moments",
    "axes": "principal_axes().axes",
    "com": "center",
    "center_of_mass": "center",
    "parallel_axis": "about(…)",
}

_TOP_RUNS = "solve(t, theta=…, psi_dot=…)"

#: Attributes of a heavy top.
OF_TOPS = {
    "run": _TOP_RUNS,
    "motion": _TOP_RUNS,
    "integrate": _TOP_RUNS,
    "simulate": _TOP_RUNS,
    "precession": "steady_precession(…)",
    "sleeping": "sleeping_threshold, least_spin(…)",
    "I1": "A",
    "I3": "C",
    "l": "R",
    "m": "mass",
}

#: Attributes of deflections.
OF_DEFLECTIONS = {
    "theta": "angle",
    "chi": "angle",
    "angles": "angle",
    "scattering_angle": "angle",
    "deflection_angle": "angle",
    "cm_angle": "angle",
    "b": "impact_parameter",
    "r_min": "closest_approach",
    "distance_of_closest_approach": "closest_approach",
    "lab_angle": "known of both masses: visviva.scattering.lab_angle(cm_angle=…, mass_ratio=…)",
    "theta_lab": "known of both masses: visviva.scattering.lab_angle(cm_angle=…, mass_ratio=…)",
    "cross_section": "known of all impact parameters: visviva.scattering.cross_section(potential=…, energy=…, angle=…)",
}

#: Attributes of potentials.
OF_POTENTIALS = {
    "V": "value(r)",
    "U": "value(r)",
    "energy": "value(r)",
    "potential": "value(r)",
    "evaluate": "value(r)",
    "F": "force(r)",
    "derivative": "force(r), with the other sign",
    "gradient": "force(r), with the other sign",
    "second_derivative": "curvature(r)",
}

_SPLIT = "kinetic_split, the parts of L by degrees of the velocities"

#: Attributes of systems in generalized coordinates.
OF_SYSTEMS = {
    "integrate": "run(t=…)",
    "solve": "run(t=…)",
    "simulate": "run(t=…)",
    "equations_of_motion": "equations",
    "eom": "equations",
    "euler_lagrange": "equations",
    "hamiltons_equations": "equations",
    "latex": "equations, which a notebook shows set",
    "q": "position",
    "qdot": "velocity",
    "p": "momentum",
    "conjugate_momenta": "momentum, and momenta as expressions",
    "generalized_momenta": "momentum, and momenta as expressions",
    "T": _SPLIT,
    "V": _SPLIT,
    "kinetic_energy": _SPLIT,
    "potential_energy": _SPLIT,
    "H": "energy",
    "Hamiltonian": "hamiltonian()",
    "to_hamiltonian": "hamiltonian()",
    "to_lagrangian": "lagrangian()",
    "energy_function": "energy",
    "hessian": "mass_matrix",
    "M": "mass_matrix",
    "conserved_quantities": "conserved",
    "symmetries": "conserved, and noether(generator) tests one of yours",
    "noether_charge": "noether(generator)",
    "cyclic_coordinates": "cyclic",
    "poisson_bracket": "poisson(…)",
    "poincare_section": "poincare(section, t)",
    "poincare_map": "poincare(section, t)",
    "phase_space": "phase_portrait(position, momentum)",
    "phase_plot": "phase_portrait(position, momentum)",
    "lyapunov": "lyapunov_exponents(t)",
    "state_transition_matrix": "flow_jacobian(t)",
    "advise": "run(t, rtol=…)",
    "megno": "lyapunov_exponents(t)",
    "frequencies": "normal_modes().frequencies",
    "eigenfrequencies": "normal_modes().frequencies",
    "small_oscillations": "normal_modes()",
    "stability": "equilibria(), each with stable",
    "effective_potential": "plot_effective_potential(position)",
    "with_state": "at(position=…, t0=…)",
    "with_parameters": "at(parameters=…)",
    "subs": "at(parameters=…)",
    "plot": "run(t=…).plot()",
    "animate": "run(t=…).animate(…)",
}


def no_attribute(answers: Mapping[str, str]) -> Callable[[object, str], NoReturn]:
    """The ``__getattr__`` of a class: a name that is not there is refused with what it is here."""

    def refused(of: object, name: str) -> NoReturn:
        advice = f"; it is {answers[name]}" if name in answers else ""
        raise AttributeError(f"{type(of).__name__!r} object has no attribute {name!r}{advice}", name=name, obj=of)

    return refused


def __dir__() -> list[str]:
    return list(__all__)
