"""What people know by another name from elsewhere, and what it is here.

The one idea: whoever writes such a name means something, which the refusal says. Names that are nearly those of visviva
need nothing here: the nearest is told of itself.
"""

from __future__ import annotations

__all__ = ["MISSING", "OF_KEYWORDS", "OF_RUNS", "OF_SCENES", "OF_THE_PACKAGE", "SOLID", "SYMBOLS"]

_OUTPUTS = "give output times as t, as np.linspace(t0, t1, n); a method with equal steps takes their length as dt"
_COPIES = "give states, masses or parameters with a leading axis over the copies, and there are as many"
_BY_SPIN = "give it as angular_velocity, along the body's axes"
#: What to give of a solid.
SOLID = "give mass=solid.mass, inertia=solid.tensor of a solid of vv.rigid"

#: Keywords: function, keyword, what to do.
OF_KEYWORDS = {
    ("run", "t_eval"): "the output times are t",
    ("run", "t_span"): "give the end, or the output times, as t; the start is the scene's t0",
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
    ("RigidBody", "shape"): SOLID,
    ("RigidBody", "radius"): SOLID,
    ("UniformField", "gravity"): "give it as g, a vector, as [0, 0, -9.81]",
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

#: Attributes of the package.
OF_THE_PACKAGE = {
    "Simulation": "make a visviva.Scene of Particles and forces, and run it: see 'coming from REBOUND'",
    "integrate": "a scene runs itself: visviva.Scene(…).run(t=…)",
    "odeint": "it is visviva.solve_ivp(fun, t_span, y0), whose function takes the time first",
    "MjModel": "make a visviva.Scene of RigidBody and forces: see 'coming from MuJoCo'",
    "Body": "points are visviva.Particles, several at once; bodies that turn are visviva.RigidBody",
    "CustomForce": "it is visviva.ExpressionForce(force=…), or potential=… where it has one",
    "Ensemble": "a scene makes one: visviva.Scene(…).ensemble(…)",
    "G": "it is visviva.units.SI.G in SI; each system of visviva.units has its own",
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

#: Attributes of a run: what it is.
OF_RUNS = {
    "y": "position and velocity",
    "sol": "position and velocity at the times asked for; outputs between steps cost little and change no step",
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
    "potential": "potential_energy",
    "omega": "angular_velocity",
    "quaternion": "orientation, (x, y, z, w)",
    "rotation": "vv.rigid.matrix(out.orientation)",
    "euler_angles": "vv.rigid.euler_angles(out.orientation, …)",
    "df": "to_pandas()",
    "to_csv": "to_pandas().to_csv(path)",
    "final_state": "final, a scene to go on from",
    "distance": "np.linalg.norm(out.position[:, 0] - out.position[:, 1], axis=-1)",
}


def __dir__() -> list[str]:
    return list(__all__)
