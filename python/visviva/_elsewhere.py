"""What people know by another name from elsewhere, and what it is here.

The one idea: whoever writes such a name means something, which the refusal says. Names that are nearly those of visviva
need nothing here: the nearest is told of itself.
"""

from __future__ import annotations

__all__ = ["MISSING", "OF_KEYWORDS", "OF_RUNS", "OF_SCENES", "OF_TABLES", "SOLID", "SYMBOLS"]

_OUTPUTS = "give output times as t, as np.linspace(t0, t1, n); a method with equal steps takes their length as dt"
_COPIES = "give states, masses or parameters with a leading axis over the copies, and there are as many"
_SPRING_APART = "damping is that of a damper beside it: vv.Damper(i=…, j=…, c=…)"
_TAU = "of a force −γ v give tau = m / γ, the time in which velocities fall by a factor e"
_QUADRATIC = "give it as coefficient, of the force −coefficient |v| v"
_CROSS_SECTION = "vv.drag.quadratic(density=…, radius=…, drag_coefficient=…) makes the force of it"
_BY_ANGLES = "give orientation=vv.rigid.quaternion_from_euler(angles)"
_BY_SPIN = "give it as angular_velocity, along the body's axes"
#: What to give of a solid.
SOLID = "give mass=solid.mass, inertia=solid.tensor of a solid of vv.rigid"

#: Keywords: function, keyword, what to do.
OF_KEYWORDS = {
    ("run", "t_eval"): "the output times are t",
    ("run", "t_span"): "give the end, or the output times, as t; the start is the scene's t0",
    (
        "run",
        "accuracy",
    ): "rtol bounds the error of each step; scene.advise(t, accuracy=…) finds how to keep one of the run",
    ("Runs.run", "accuracy"): "give rtol, which bounds the error of each step",
    ("GeneralizedEnsemble.run", "accuracy"): "give rtol, which bounds the error of each step",
    ("run", "tolerance"): "give it as rtol, and what is absolute as atol",
    ("run", "precision"): "give it as rtol",
    ("advise", "rtol"): "give the error that the whole run may have as accuracy",
    ("run", "t_end"): "give the end, or the output times, as t",
    ("run", "tmax"): "give the end, or the output times, as t",
    ("run", "duration"): "give the end, or the output times, as t",
    ("run", "n"): _OUTPUTS,
    ("run", "steps"): _OUTPUTS,
    ("run", "n_steps"): _OUTPUTS,
    ("run", "num_steps"): _OUTPUTS,
    ("run", "step"): "give it as dt",
    ("run", "h"): "give it as dt",
    ("run", "timestep"): "give it as dt",
    ("run", "dense_output"): "give as t the times you want: outputs between steps cost little and change no step",
    ("run", "first_step"): "the first step follows from rtol; max_step bounds it",
    ("run", "y0"): "the initial state is the scene's: see Scene.with_state",
    ("run", "integrator"): "give it as method",
    ("run", "solver"): "give it as method",
    ("ensemble", "n"): _COPIES,
    ("ensemble", "copies"): _COPIES,
    ("ensemble", "G"): "give values of a force's parameters as parameters={'Gravity': {'G': values}}",
    ("state", "semi_major_axis"): "give pericenter = a|1 − e| (of repulsion a(e + 1))",
    ("state", "longitude_of_ascending_node"): "give it as node",
    ("Particles", "m"): "give it as mass",
    ("Particles", "x"): "give positions as position, of shape (N, 3)",
    ("Particles", "pos"): "give it as position",
    ("Particles", "v"): "give it as velocity",
    ("Particles", "vel"): "give it as velocity",
    ("Particles", "charge"): "charges belong to the forces on them: vv.Coulomb(charge=…), vv.UniformMagneticField(…)",
    ("Particles", "charges"): "charges belong to the forces on them: vv.Coulomb(charge=…), vv.UniformMagneticField(…)",
    ("RigidBody", "omega"): _BY_SPIN,
    ("RigidBody", "w"): _BY_SPIN,
    ("RigidBody", "spin"): _BY_SPIN,
    ("RigidBody", "quaternion"): "give it as orientation, (x, y, z, w)",
    ("RigidBody", "I"): "give it as moments, three of them, or as inertia, of shape (3, 3)",
    ("RigidBody", "tensor"): "give it as inertia",
    ("RigidBody", "euler_angles"): _BY_ANGLES,
    ("RigidBody", "angles"): _BY_ANGLES,
    ("RigidBody", "fixed_point"): "give it as pivot",
    ("RigidBody", "shape"): SOLID,
    ("RigidBody", "radius"): SOLID,
    ("UniformField", "gravity"): "give it as g, a vector, as [0, 0, -9.81]",
    ("UniformField", "acceleration"): "give it as g",
    ("UniformField", "field"): "give it as g",
    ("Gravity", "epsilon"): "give it as softening, a length",
    ("Gravity", "eps"): "give it as softening, a length",
    ("Gravity", "constant"): "give it as G",
    ("Harmonic", "stiffness"): "give it as k",
    ("Harmonic", "omega"): "give k = m ω²",
    ("Spring", "stiffness"): "give it as k",
    ("Spring", "spring_constant"): "give it as k",
    ("Spring", "damping"): _SPRING_APART,
    ("Spring", "c"): _SPRING_APART,
    ("Spring", "rest_length"): "give it as length",
    ("Spring", "natural_length"): "give it as length",
    ("Spring", "L0"): "give it as length",
    ("Spring", "l0"): "give it as length",
    ("Spring", "bodies"): "give the two ends as i and j",
    ("Damper", "damping"): "give it as c",
    ("Damper", "coefficient"): "give it as c",
    ("Damper", "gamma"): "give it as c",
    ("Damper", "b"): "give it as c",
    ("Damper", "k"): "stiffness is that of a spring beside it: vv.Spring(i=…, j=…, k=…)",
    ("Damper", "stiffness"): "stiffness is that of a spring beside it: vv.Spring(i=…, j=…, k=…)",
    ("Damper", "bodies"): "give the two ends as i and j",
    ("AttachedSpring", "k"): "give it as stiffness",
    ("AttachedSpring", "c"): "give it as damping",
    ("AttachedSpring", "rest_length"): "give it as length",
    ("LinearDrag", "gamma"): _TAU,
    ("LinearDrag", "b"): _TAU,
    ("LinearDrag", "c"): _TAU,
    ("LinearDrag", "k"): _TAU,
    ("LinearDrag", "coefficient"): _TAU,
    ("LinearDrag", "damping"): _TAU,
    ("LinearDrag", "rate"): "give tau = 1 / rate, the time in which velocities fall by a factor e",
    ("QuadraticDrag", "k"): _QUADRATIC,
    ("QuadraticDrag", "c"): _QUADRATIC,
    ("QuadraticDrag", "b"): _QUADRATIC,
    ("QuadraticDrag", "gamma"): _QUADRATIC,
    ("QuadraticDrag", "Cd"): _CROSS_SECTION,
    ("QuadraticDrag", "drag_coefficient"): _CROSS_SECTION,
    ("RotationalDrag", "damping"): "give it as coefficient, of the torque −coefficient ω",
    ("RotationalDrag", "gamma"): "give it as coefficient, of the torque −coefficient ω",
    ("RotationalDrag", "c"): "give it as coefficient, of the torque −coefficient ω",
    ("RotatingFrame", "Omega"): "give it as omega",
    ("RotatingFrame", "angular_velocity"): "give it as omega",
    ("DrivenForce", "omega"): "give it as frequency, in radians per time",
    ("DrivenForce", "F0"): "give it as amplitude, a vector",
    ("DrivenForce", "force"): "give it as amplitude, a vector",
    ("UniformElectricField", "field"): "give it as E",
    ("UniformMagneticField", "field"): "give it as B",
    ("ExpressionForce", "V"): "give it as potential",
    ("ExpressionForce", "F"): "give it as force",
    ("ExpressionForce", "body"): "give it as bodies",
    ("Lagrangian", "q"): "give it as coordinates",
    ("Lagrangian", "momentum"): "give it as velocity, or make a vv.Hamiltonian",
    ("Lagrangian", "damping"): "give Rayleigh's function as dissipation",
    ("Hamiltonian", "coordinates"): "give it as q",
    ("Hamiltonian", "momenta"): "give it as p",
    ("Hamiltonian", "velocity"): "give it as momentum",
    ("distance", "distance"): "give it as below",
    ("distance", "radius"): "give it as below",
    ("from_elements", "a"): "give it as semi_major_axis",
    ("from_elements", "e"): "give it as eccentricity",
    ("from_elements", "inc"): "give it as inclination",
    ("from_elements", "Omega"): "give it as longitude_of_ascending_node",
    ("from_elements", "omega"): "give it as argument_of_pericenter",
    ("from_elements", "f"): "give it as true_anomaly",
    ("from_elements", "M"): "give it as mean_anomaly",
    ("from_elements", "central_mass"): "give it as central",
    ("from_elements", "node"): "give it as longitude_of_ascending_node",
    ("from_elements", "apocenter"): "give semi_major_axis and eccentricity",
    ("from_elements", "mu"): "it follows from G and the masses",
}

#: Symbols of books, and what they are called, where a function takes that.
SYMBOLS = {
    "b": ("impact_parameter",),
    "q": ("charge",),
    "mu": ("reduced_mass",),
    "E": ("energy", "beam_energy"),
    "E0": ("beam_energy", "energy"),
    "theta": ("angle", "cm_angle", "lab_angle"),
    "chi": ("angle", "cm_angle"),
    "N": ("n_events",),
    "n": ("n_events",),
    "events": ("n_events",),
    "particles": ("n_events",),
    "V": ("potential",),
    "q0": ("position",),
    "x0": ("position",),
    "v0": ("velocity",),
    "qdot0": ("velocity",),
    "p0": ("momentum",),
    "params": ("parameters",),
}

# Only scenes are saved while they run: what to do elsewhere, by the qualified name of what is called.
_IN_PARTS = {
    "Runs.run": "only runs of scenes are saved as they go; run to a time, out.save(path), and go on from "
    "visviva.load(path).final",
    "GeneralizedEnsemble.run": "only runs of scenes are saved as they go; run to a time, out.save(path), and go on "
    "from visviva.load(path)[i].final, copy by copy",
    "monte_carlo": "count events in parts: save each result, go on with first_event=result.next_event, and add them",
    "Foil.run": "bombard in parts: save each result, go on with first_event=result.next_event, and add them",
}
OF_KEYWORDS |= {(name, keyword): cure for name, cure in _IN_PARTS.items() for keyword in ("save_every", "save_to")}

#: Arguments that are missing, likewise: what to give.
MISSING = {
    ("Gravity", "G"): "as Gravity(1.0) in units of your own, or Gravity(vv.units.SI.G)",
    ("run", "t"): "as run(t=10.0), or run(t=np.linspace(0.0, 10.0, 101))",
}

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
    "t": "it is t0; run(t=…) takes the end",
    "dt": "it is an argument of run",
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
    "acceleration": "final.acceleration() where it ends",
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


def __dir__() -> list[str]:
    return list(__all__)
