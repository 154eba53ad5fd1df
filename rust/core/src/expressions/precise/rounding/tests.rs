use super::*;
use crate::expressions::graph::Graph;

/// What rounding leaves of the function, of which `make` builds the node.
fn told(
    make: impl Fn(&mut Graph, crate::expressions::graph::Id) -> crate::expressions::graph::Id,
    x: f64,
) -> (f64, f64) {
    let mut graph = Graph::default();
    let r = graph.variable(0);
    let root = make(&mut graph, r);
    let (value, off) = Precise::new(&graph, &[root]).told(DoubleDouble::from(x))[0];
    (value.high(), off)
}

#[test]
fn what_is_left_of_near_values_is_known_until_it_is_less_than_their_rounding() {
    // √(1 + r²) − r = 1/2r far out.
    let left = |r: f64| {
        told(
            |graph, r| {
                let square = graph.multiply(r, r);
                let sum = graph.sum(1.0, &[(1.0, square)]);
                let root = graph.call(Function::Sqrt, sum);
                graph.subtract(root, r)
            },
            r,
        )
    };
    for (r, known) in [(1.0, 4e-14), (1e6, 1e-16), (1e10, 4e-9), (1e14, 0.3)] {
        let (value, off) = left(r);
        let exact = 1.0 / (r + r.hypot(1.0));
        assert!((value - exact).abs() <= off + 4.0 * f64::EPSILON * exact, "{r}: {value}");
        assert!(off <= known * exact, "{r}: {off}");
    }
    let (value, off) = left(1e18);
    assert!(off > value.abs() && off > 0.5e-18);
}

#[test]
fn what_left_the_range_on_the_way_is_told_where_it_matters() {
    // u/√(u²)^(2/3), where u² is none any more; and one over a sum with what is none.
    let root = |graph: &mut Graph, r| {
        let square = graph.multiply(r, r);
        let size = graph.call(Function::Sqrt, square);
        let power = graph.power(size, 2.0 / 3.0);
        graph.divide(r, power)
    };
    let (value, off) = told(root, 1e130);
    assert!((value - 2.154_434_690_031_884e43).abs() < 1e30 && off < 1e14 * value * 1e-28);
    let (value, off) = told(root, 1e160);
    assert!(value > 0.0 && off >= 0.5 * value);
    let step = |graph: &mut Graph, r| {
        let grown = graph.call(Function::Exp, r);
        let sum = graph.sum(1.0, &[(1.0, grown)]);
        let one = graph.constant(1.0);
        graph.divide(one, sum)
    };
    let (value, off) = told(step, 1e4);
    assert!(value.abs() + off < 1e-270);
    let tanh = |graph: &mut Graph, r| {
        let grown = graph.call(Function::Exp, r);
        graph.call(Function::Tanh, grown)
    };
    let (value, off) = told(tanh, 1e4);
    assert!(value == 1.0 && off < 1e-14);
}
