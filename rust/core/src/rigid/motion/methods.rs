//! Methods for rigid bodies alone: leapfrogs whose drift turns bodies by a discrete motion instead of the exact one.
//!
//! Of a body that nothing turns their order is that of the discrete motion; with torques, and of points, they are leapfrogs.

use crate::ode::methods::leapfrog;
use crate::ode::{Method, Scheme, Splitting};
use crate::rigid::flow::moser_veselov::Order;

const REFERENCE: &str = "Moser & Veselov, Commun. Math. Phys. 139 (1991) 217; McLachlan & Zanna, Found. Comput. Math. 5 (2005) 87; \
                         Hairer & Vilmart, J. Phys. A 39 (2006) 13225";

const fn method(name: &'static str, order: u32, summary: &'static str) -> Method {
    Method {
        name,
        summary,
        order,
        stages: 1,
        symplectic: true,
        reversible: true,
        dense_order: order,
        reference: REFERENCE,
        scheme: Scheme::Splitting(Splitting { kicks: leapfrog::KICKS, drifts: leapfrog::DRIFTS }),
    }
}

macro_rules! of_order {
    ($order:literal) => {
        concat!(
            "Rigid bodies: the discrete Moser–Veselov motion of order ",
            $order,
            " where nothing turns them, a leapfrog of order 2 with torques; keeps energy and angular momentum."
        )
    };
}

/// RATTLE on the group of rotations, which is the discrete motion itself.
pub static RATTLE: Method = method(
    "rattle",
    2,
    "Rigid bodies: RATTLE on the group of rotations, symplectic, order 2; of a body that nothing turns moser_veselov2.",
);
/// With the body's own moments.
pub static MOSER_VESELOV2: Method = method("moser_veselov2", 2, of_order!("2"));
/// With moments modified to fourth order.
pub static MOSER_VESELOV4: Method = method("moser_veselov4", 4, of_order!("4"));
/// To sixth.
pub static MOSER_VESELOV6: Method = method("moser_veselov6", 6, of_order!("6"));
/// To eighth.
pub static MOSER_VESELOV8: Method = method("moser_veselov8", 8, of_order!("8"));
/// To tenth.
pub static MOSER_VESELOV10: Method = method("moser_veselov10", 10, of_order!("10"));

/// All of them, with the order of the discrete motion.
pub static METHODS: [(&Method, Order); 6] = [
    (&RATTLE, Order::Two),
    (&MOSER_VESELOV2, Order::Two),
    (&MOSER_VESELOV4, Order::Four),
    (&MOSER_VESELOV6, Order::Six),
    (&MOSER_VESELOV8, Order::Eight),
    (&MOSER_VESELOV10, Order::Ten),
];

/// The order of the discrete motion of a method, if it has one.
pub fn discrete(method: &Method) -> Option<Order> {
    METHODS.iter().find(|(other, _)| other.name == method.name).map(|(_, order)| *order)
}
