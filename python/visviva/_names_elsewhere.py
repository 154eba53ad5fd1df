"""Names that people look for in the package and its rooms, from other packages and books, and what there is here.

The one idea: an answer is for all the names of one thing, whatever their capitals and underscores, and what it names is
there, with the arguments that it names: a test reads all of them.
"""

from __future__ import annotations

__all__ = ["ANSWERS", "IN_ROOMS", "answer", "plain"]

_METHOD = "it is a method of a run: visviva.Scene(…).run(t=…, method={!r}, dt=…); visviva.methods() has all"
_CHOSEN = "methods go by name, as visviva.Scene(…).run(t=…, method='verner98'); visviva.methods() has all"
_SOLID = "it is a solid of visviva.rigid: visviva.rigid.{}, whose mass and tensor are what RigidBody takes"

#: Names, and what there is.
ANSWERS: dict[tuple[str, ...], str] = {
    # What is simulated.
    ("Simulation", "Simulator", "World", "NBody", "System", "Model", "run"): (
        "make a visviva.Scene of Particles and forces, and run it: see 'coming from REBOUND'"
    ),
    ("MjModel", "MjData", "mj_step"): "make a visviva.Scene of RigidBody and forces: see 'coming from MuJoCo'",
    ("integrate", "simulate", "evolve", "step"): "a scene runs itself: visviva.Scene(…).run(t=…)",
    ("odeint", "ode", "ode_solver", "solve"): (
        "it is visviva.solve_ivp(fun, t_span, y0), whose function takes the time first"
    ),
    ("taylor_adaptive", "make_vars", "cfunc"): (
        "equations of your own go to visviva.solve_ivp(fun, t_span, y0), formulas of forces to "
        "visviva.ExpressionForce(force=…), and a Lagrangian to visviva.Lagrangian; method='taylor' is theirs, too"
    ),
    ("Body", "PointMass", "Star", "Sun", "Planet", "Moon", "Satellite", "Asteroid", "Planets"): (
        "points are visviva.Particles, several at once; bodies that turn are visviva.RigidBody"
    ),
    ("TestParticle", "TestParticles", "Tracer", "Tracers"): (
        "a body of mass 0 in visviva.Particles feels the others and does not act on them"
    ),
    ("OrbitalElements", "KeplerianElements", "from_elements"): (
        "visviva.Particles.from_elements makes bodies of elements; visviva.orbits.elements and elements() of a scene "
        "or run tell them"
    ),
    ("Ensemble",): "a scene makes one: visviva.Scene(…).ensemble(…)",
    # Forces.
    ("UniformGravity", "ConstantGravity", "ConstantField", "EarthGravity", "GravityField", "Weight", "g"): (
        "it is visviva.UniformField(g=[0, 0, -9.81])"
    ),
    ("Newton", "Newtonian", "NewtonianGravity", "Gravitation"): "it is visviva.Gravity(G=…)",
    ("ConstantForce", "ExternalForce", "ForceField"): (
        "an acceleration that is the same everywhere is visviva.UniformField(g=…); other forces are "
        "visviva.ExpressionForce(force=…), also constant ones"
    ),
    ("CustomForce", "UserForce", "additional_forces", "Field"): (
        "it is visviva.ExpressionForce(force=…), or potential=… where it has one"
    ),
    ("CustomPotential", "ExternalPotential"): (
        "between bodies or about a center it is visviva.potentials.Custom(function=…), given to visviva.PairPotential "
        "or visviva.CentralField; of the place it is visviva.ExpressionForce(potential=…)"
    ),
    ("Kepler", "CentralForce", "Central"): (
        "it is visviva.CentralField(potential=…), as with visviva.potentials.Coulomb(k=-1.0)"
    ),
    ("Lorentz", "LorentzForce", "MagneticField", "Magnetic", "ConstantMagneticField"): (
        "it is visviva.UniformMagneticField(B=…, charge=…), beside visviva.UniformElectricField(E=…, charge=…)"
    ),
    ("ElectricField", "Electric", "ConstantElectricField"): "it is visviva.UniformElectricField(E=…, charge=…)",
    ("Electrostatic", "Electrostatics", "CoulombForce"): "it is visviva.Coulomb(charge=…, k=…)",
    ("J2", "J4", "Oblateness", "GravitationalHarmonics", "SphericalHarmonics"): (
        "it is visviva.Oblate(body=…, G=…, J2=…, radius=…, axis=…)"
    ),
    ("GR", "Relativity", "GeneralRelativity", "Relativistic", "Schwarzschild", "gr_potential"): (
        "it is visviva.PostNewtonian(body=…, G=…, c=…), to the first post-Newtonian order"
    ),
    ("Coriolis", "Centrifugal", "FictitiousForces", "RotatingCoordinates"): "it is visviva.RotatingFrame(omega=…)",
    (
        "RadiationPressure",
        "RadiationForces",
        "PoyntingRobertson",
        "SolarSail",
        "Yarkovsky",
        "Tides",
        "TidesConstantTimeLag",
    ): ("there is none; what has a formula of place, velocity and time is visviva.ExpressionForce(acceleration=…)"),
    ("Friction", "Viscous", "Damping", "AirResistance", "AirDrag", "ViscousDrag"): (
        "linear in the velocity it is visviva.LinearDrag(tau=…), quadratic visviva.QuadraticDrag(coefficient=…), of "
        "the turning of a body visviva.RotationalDrag(coefficient=…); a Lagrangian takes dissipation=…"
    ),
    ("StokesDrag", "Stokes"): "it is visviva.drag.stokes(mass=…, radius=…, viscosity=…)",
    ("Hooke", "HookeanSpring", "Springs", "SpringDamper", "Bond", "Tendon"): (
        "between points it is visviva.Spring(i=…, j=…, k=…, length=…), with visviva.Damper(i=…, j=…, c=…) beside it; "
        "on rigid bodies it is visviva.AttachedSpring(body=…, point=…, stiffness=…, damping=…)"
    ),
    ("HarmonicOscillator", "Oscillator", "HarmonicTrap", "Trap"): (
        "the force to a center is visviva.Harmonic(k=…), and visviva.systems.oscillator(k=…, m=…) is a Lagrangian"
    ),
    ("ForcedOscillator", "DrivenOscillator", "PeriodicForce", "Drive", "Driving"): (
        "the force is visviva.DrivenForce(amplitude=…, frequency=…, phase=…)"
    ),
    ("Torque", "ExternalTorque", "Motor", "Actuator"): (
        "it is visviva.AppliedTorque(torque=…, body=…, frame=…); of a formula, visviva.ExpressionTorque(function=…)"
    ),
    # Bodies that turn, and what holds them.
    ("Joint", "Joints", "Hinge", "Constraint", "Constraints", "Weld", "RigidRod", "Rope"): (
        "there are no joints between bodies: a body that is held at a point has a pivot=…, as "
        "visviva.RigidBody(mass=…, moments=…, pivot=…), springs are visviva.AttachedSpring, and visviva.Lagrangian "
        "takes constraints=…"
    ),
    ("Sphere",): _SOLID.format("sphere"),
    ("Box", "Cuboid"): _SOLID.format("box"),
    ("Cylinder",): _SOLID.format("cylinder"),
    ("Rod",): _SOLID.format("rod"),
    ("Solid", "Shape", "Geom", "Inertia", "MomentOfInertia"): (
        "visviva.rigid has solids, as visviva.rigid.sphere(mass=…, radius=…), and visviva.rigid.inertia_tensor(mass=…, "
        "position=…) of points"
    ),
    ("Gyroscope", "Top", "SpinningTop", "HeavySymmetricTop"): (
        "in closed form it is visviva.rigid.HeavyTop(A=…, C=…, mass=…, g=…, R=…); in a scene it is a RigidBody with a "
        "pivot"
    ),
    ("Quaternion", "Rotation", "Orientation"): (
        "quaternions are arrays (x, y, z, w), as of SciPy: visviva.rigid.quaternion_from_euler, visviva.rigid.rotate, "
        "visviva.rigid.matrix, visviva.rigid.from_scipy"
    ),
    # Systems of books.
    ("Pendulum", "SimplePendulum"): "it is visviva.systems.pendulum(l=…, m=…, g=…)",
    ("DoublePendulum",): "it is visviva.systems.double_pendulum(l1=…, l2=…, m1=…, m2=…)",
    ("TwoBody", "TwoBodyProblem", "KeplerProblem"): (
        "it is a visviva.Scene of two Particles and Gravity, solved in closed form; visviva.problems.kepler(e=…) is one"
    ),
    ("ThreeBody", "ThreeBodyProblem", "FigureEight"): (
        "it is a visviva.Scene of three Particles and Gravity; visviva.problems.figure_eight() is one"
    ),
    ("SolarSystem", "solar_system"): "it is visviva.datasets.solar_system",
    ("LagrangesMethod", "KanesMethod", "EulerLagrange", "equations_of_motion"): (
        "visviva.Lagrangian(L=…, coordinates=…) derives the equations: equations()"
    ),
    ("dynamicsymbols", "symbols", "Symbol"): "coordinates are visviva.coordinate('x y'), the time is visviva.time",
    ("t",): "the time in formulas is visviva.time",
    ("Routhian", "Noether", "PoissonBracket", "NormalModes", "Linearize", "normal_modes", "HamiltonsEquations"): (
        "it is a method of a visviva.Lagrangian or visviva.Hamiltonian: dir() of one lists them"
    ),
    ("Poincare", "PoincareMap", "SurfaceOfSection"): "it is poincare(…) of a visviva.Lagrangian or visviva.Hamiltonian",
    ("Lyapunov", "LyapunovExponent", "LyapunovExponents", "Chaos"): (
        "it is visviva.Scene(…).megno(t=…), and lyapunov_exponents(…) of a visviva.Lagrangian"
    ),
    # Methods.
    ("RungeKutta", "RungeKutta4", "RK4"): _METHOD.format("rk4"),
    ("Euler",): _METHOD.format("euler"),
    ("Leapfrog", "Verlet", "VelocityVerlet", "StormerVerlet"): _METHOD.format("leapfrog"),
    ("Yoshida",): _METHOD.format("yoshida4"),
    ("Boris", "BorisPusher"): _METHOD.format("boris"),
    ("Integrator", "Integrators", "Solver", "IAS15", "WHFast", "Mercurius", "Trace", "DOP853", "RK45"): _CHOSEN,
    # Events, collisions and results.
    ("Collision", "Contact", "Bounce", "HardSpheres"): (
        "bodies that have a radius collide in visviva.Scene(…).run(t=…, collisions=…, restitution=…); "
        "visviva.collisions has the laws of one impact"
    ),
    ("Detector", "Trigger", "StopCondition"): "visviva.events has what run(events=[…]) looks for",
    ("Rutherford", "RutherfordScattering", "rutherford"): (
        "visviva.scattering.rutherford_angle and visviva.scattering.rutherford_cross_section are closed forms; "
        "visviva.scattering.deflect(potential=…, energy=…, impact_parameter=…) is of any potential"
    ),
    ("DifferentialCrossSection", "dsigma_domega", "CrossSections"): (
        "it is visviva.scattering.cross_section(potential=…, energy=…, angle=…)"
    ),
    ("ImpactParameter", "ScatteringAngle", "DeflectionFunction", "scatter"): (
        "it is visviva.scattering.deflect(potential=…, energy=…, impact_parameter=…), and "
        "visviva.scattering.impact_parameter(potential=…, energy=…, angle=…) is the way back"
    ),
    ("Orbit", "Ellipse"): (
        "visviva.orbits has what is known of one: visviva.orbits.elements(mu=…, position=…, velocity=…), "
        "visviva.orbits.central_orbit(potential=…, position=…, velocity=…)"
    ),
    ("save", "open", "read", "from_file", "Simulationarchive"): (
        "a run is saved by its own save(path), and read by visviva.load(path)"
    ),
    ("animate", "movie"): "a run has pictures: visviva.Scene(…).run(t=…).animate(…)",
    # Constants.
    ("gravitational_constant", "constants", "G"): (
        "it is visviva.units.SI.G in SI; each system of visviva.units has its own, and SOLAR_MASS, SPEED_OF_LIGHT and "
        "others are there in SI"
    ),
    ("AU", "astronomical_unit"): "it is visviva.units.ASTRONOMICAL_UNIT, in meters",
    ("c", "speed_of_light"): "it is visviva.units.SPEED_OF_LIGHT, in meters a second",
    ("M_sun", "solar_mass"): "it is visviva.units.SOLAR_MASS, in kilograms",
}


#: Names that are looked for in a room, by its name.
IN_ROOMS: dict[str, dict[tuple[str, ...], str]] = {
    "events": {
        ("collision", "contact", "impact", "bounce"): (
            "bodies that have a radius collide in visviva.Scene(…).run(t=…, collisions=…); the distance of two centers "
            "is visviva.events.distance(first=…, second=…, below=…)"
        ),
        ("close_encounter", "encounter", "approach"): "it is visviva.events.distance(first=…, second=…, below=…)",
        ("periapsis", "pericenter", "perihelion", "perigee"): (
            "it is visviva.events.apsis(body=…, about=…, direction=1)"
        ),
        ("apoapsis", "apocenter", "aphelion", "apogee"): "it is visviva.events.apsis(body=…, about=…, direction=-1)",
        ("time", "t", "at_time", "at"): "times are no events: give them to the run as t, as np.linspace(t0, t1, n)",
        ("position", "crossing", "crosses", "section", "ground", "floor", "node", "z"): (
            "it is visviva.events.plane(point=…, normal=…, body=…)"
        ),
        ("velocity", "speed", "turning_point", "angle", "custom", "condition", "zero"): (
            "what has no event of its own is a function (t, position, velocity) that is zero there: "
            "visviva.events.function(call=…)"
        ),
        ("escape", "ejection"): (
            "it is visviva.events.distance(first=…, second=…, below=…, direction=1, terminal=True): where the distance "
            "grows beyond it"
        ),
    },
    "systems": {
        ("kepler", "central", "central_potential"): "it is visviva.systems.central_force(potential=…, m=…)",
        ("elastic_pendulum", "spring_mass_pendulum"): "it is visviva.systems.spring_pendulum(k=…, l=…, m=…, g=…)",
        ("pendulum_on_cart", "pendulum_cart", "cartpole"): "it is visviva.systems.cart_pendulum(l=…, m=…, cart=…, g=…)",
        ("inverted_pendulum", "driven_pendulum", "parametric_pendulum"): (
            "a pendulum whose pivot is shaken is visviva.systems.kapitza(a=…, Omega=…), or "
            "visviva.systems.moving_pivot(X=…, Y=…, Omega=…); visviva.systems.pendulum(position=…) may start anywhere"
        ),
        ("triple_pendulum", "n_pendulum", "multiple_pendulum"): "it is visviva.systems.chain(n=…, l=…, m=…, g=…)",
        ("coupled_pendulums", "coupled_pendula", "double_spring", "coupled_springs", "springs"): (
            "small swings of coupled ones are visviva.systems.coupled_oscillators(n=…, k=…, coupling=…, m=…)"
        ),
        ("bead_on_hoop", "rotating_hoop"): "it is visviva.systems.hoop(R=…, Omega=…)",
        (
            "bead_on_wire",
            "bead_on_rod",
            "bead",
            "rotating_rod",
        ): "on a rod that turns it is visviva.systems.rod(Omega=…)",
        ("heavy_top", "top", "gyroscope"): "it is visviva.rigid.HeavyTop(A=…, C=…, mass=…, g=…, R=…)",
        ("projectile", "free_particle", "free_fall"): (
            "a constant force is visviva.systems.constant_force(F=…, m=…); in space it is a Scene with UniformField"
        ),
        ("damped_oscillator", "driven_oscillator", "duffing", "van_der_pol", "anharmonic", "toda", "fpu", "fput"): (
            "there is none: visviva.Lagrangian(L=…, coordinates=…, dissipation=…, forces=…) takes any formula"
        ),
    },
    "orbits": {
        ("kepler", "kepler_equation", "solve_kepler", "eccentric_anomaly"): (
            "it is visviva.orbits.eccentric_from_mean(mean=…, eccentricity=…)"
        ),
        ("true_anomaly",): "it is visviva.orbits.true_from_eccentric(eccentric=…, eccentricity=…)",
        ("mean_anomaly",): "it is visviva.orbits.mean_from_eccentric(eccentric=…, eccentricity=…)",
        ("cartesian", "state_vector", "to_cartesian", "position"): (
            "it is visviva.orbits.state(mu=…, pericenter=…, eccentricity=…)"
        ),
        ("circular_velocity", "circular_speed"): "it is visviva.orbits.circular_orbit(potential=…, radius=…)",
        ("turning_points", "apsides", "r_min", "r_max"): (
            "it is visviva.orbits.range_of_motion(potential=…, energy=…, angular_momentum=…)"
        ),
        ("vis_viva", "escape_velocity", "hohmann", "hill_radius", "lagrange_points", "lambert", "roche"): (
            "there is none; visviva.orbits.elements(mu=…, position=…, velocity=…) has what a state tells of its orbit"
        ),
    },
    "rigid": {
        ("cube", "cuboid", "brick"): "it is visviva.rigid.box(mass=…, a=…, b=…, c=…)",
        ("ball", "solid_sphere"): "it is visviva.rigid.sphere(mass=…, radius=…)",
        ("hollow_sphere", "spherical_shell", "ball_shell"): (
            "it is visviva.rigid.sphere(mass=…, radius=…, inner_radius=…), which is radius for a thin shell"
        ),
        ("ring", "hoop"): "it is visviva.rigid.disc(mass=…, radius=…, inner_radius=…)",
        ("half_sphere",): "it is visviva.rigid.hemisphere(mass=…, radius=…)",
        ("rectangle",): "it is visviva.rigid.plate(mass=…, a=…, b=…)",
        ("point_masses",): "it is visviva.rigid.particles(mass=…, position=…)",
        ("steiner", "huygens_steiner"): "it is visviva.rigid.parallel_axis(tensor=…, mass=…, offset=…)",
        ("rotation_matrix",): "it is visviva.rigid.matrix(quaternion=…)",
        ("from_matrix",): "it is visviva.rigid.quaternion_from_matrix(matrix=…)",
        ("from_euler", "euler_to_quaternion"): "it is visviva.rigid.quaternion_from_euler(angles=…)",
        ("axis_angle", "quaternion_from_axis_angle", "from_rotvec", "from_axis_angle"): (
            "it is visviva.rigid.quaternion_from_rotation_vector(rotation_vector=…): angle times unit axis"
        ),
        ("multiply", "quaternion_multiply"): "it is visviva.rigid.quaternion_product(a=…, b=…)",
        ("inverse", "conjugate"): "visviva.rigid.rotate_back(quaternion=…, vector=…) turns the other way",
        ("free_top", "symmetric_top", "asymmetric_top", "euler_top", "euler_equations"): (
            "it is visviva.rigid.free_rotation(moments=…, angular_velocity=…, t=…)"
        ),
    },
    "scattering": {
        ("cm_to_lab", "to_lab", "theta_lab"): "it is visviva.scattering.lab_angle(cm_angle=…, mass_ratio=…)",
        ("lab_to_cm", "to_cm", "theta_cm"): "it is visviva.scattering.cm_angle(lab_angle=…, mass_ratio=…)",
        ("stopping_power",): "it is visviva.scattering.nuclear_stopping(potential=…, beam_energy=…, masses=…)",
        ("energy_loss", "recoil_energy"): "it is visviva.scattering.energy_transfer(cm_angle=…, mass_ratio=…)",
        ("viscosity_cross_section", "momentum_transfer_cross_section", "transfer_cross_section"): (
            "it is visviva.scattering.transport_cross_section"
        ),
        ("simulate", "random_events"): (
            "it is visviva.scattering.monte_carlo(potential=…, beam_energy=…, masses=…, b_max=…, n_events=…, seed=…)"
        ),
        (
            "time_delay",
        ): "a visviva.scattering.deflect(potential=…, energy=…, impact_parameter=…, reduced_mass=…) has it",
        ("rutherford_formula", "dcs", "sigma"): (
            "it is visviva.scattering.cross_section(potential=…, energy=…, angle=…), and in closed form "
            "visviva.scattering.rutherford_cross_section(potential=…, energy=…, angle=…)"
        ),
        (
            "hard_sphere",
            "coulomb",
            "potential",
        ): "potentials are in visviva.potentials, as visviva.potentials.HardSphere",
    },
    "potentials": {
        ("Gravity", "Kepler", "Newton", "Newtonian", "InverseDistance"): (
            "it is visviva.potentials.Coulomb(k=…), k < 0 where it attracts"
        ),
        ("Harmonic", "Spring", "Hooke", "Quadratic", "Polynomial"): (
            "it is visviva.potentials.Custom(function=…); the force to a center is visviva.Harmonic(k=…), and between "
            "two bodies visviva.Spring(i=…, j=…, k=…, length=…)"
        ),
        ("LJ", "Lennard", "SixTwelve"): "it is visviva.potentials.LennardJones(epsilon=…, sigma=…)",
        ("ZBL", "Moliere", "ThomasFermi"): "it is visviva.potentials.ScreenedCoulomb(k=…, length=…, screening=…)",
        ("Debye", "DebyeHuckel", "ScreenedPotential"): "it is visviva.potentials.Yukawa(k=…, length=…)",
        ("WoodsSaxon", "Gaussian", "Exponential", "Logarithmic", "Function", "Callable"): (
            "what has a formula is visviva.potentials.Custom(function=…)"
        ),
        ("Interpolated", "Table", "Spline"): "it is visviva.potentials.Tabulated(r=…, V=…)",
        ("Box", "Well", "FiniteWell", "Step"): "it is visviva.potentials.SquareWell(depth=…, radius=…)",
    },
}


def answer(name: str, answers: dict[tuple[str, ...], str]) -> str:
    """What there is for a name of elsewhere; nothing for most names.

    Examples
    --------
    >>> from visviva._names_elsewhere import ANSWERS, answer
    >>> answer("uniform_gravity", ANSWERS)
    'it is visviva.UniformField(g=[0, 0, -9.81])'
    """
    exact = next((told for names, told in answers.items() if name in names), "")
    # Of one letter or two the capitals are all there is: g is not G.
    if exact or len(name) < 3:
        return exact
    return next((told for names, told in answers.items() if plain(name) in map(plain, names)), "")


def plain(name: str) -> str:
    """A name without what people write one way or another: capitals and underscores."""
    return name.replace("_", "").lower()


def __dir__() -> list[str]:
    return list(__all__)
