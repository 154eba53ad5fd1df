//! Reference trajectories from expression to state: Taylor series of orders 36 and 44 in 200 bits.

use super::gauss;
use super::model::{Kind, Model, Source};
use super::run::{Integrator, Request, Solution, solve};
use crate::expressions::function::Function;
use crate::expressions::{Graph, Id};
use crate::parallel::{Control, Ticker};

/// A chain of `n` unit masses on unit links; angles from the vertical, g as a parameter.
fn chain(n: u32) -> Model {
    let mut graph = Graph::default();
    let g = graph.parameter(0);
    let angles: Vec<Id> = (0..n).map(|i| graph.variable(i)).collect();
    let rates: Vec<Id> = (n..2 * n).map(|i| graph.variable(i)).collect();
    let mut terms = Vec::new();
    let (mut x, mut y, mut height) = (vec![], vec![], vec![]);
    for i in 0..n as usize {
        let (sine, cosine) = (graph.call(Function::Sin, angles[i]), graph.call(Function::Cos, angles[i]));
        x.push((1.0, graph.multiply(cosine, rates[i])));
        y.push((1.0, graph.multiply(sine, rates[i])));
        height.push((1.0, cosine));
        let (vx, vy, h) = (graph.sum(0.0, &x), graph.sum(0.0, &y), graph.sum(0.0, &height));
        let (vx2, vy2, potential) = (graph.multiply(vx, vx), graph.multiply(vy, vy), graph.multiply(g, h));
        terms.extend([(0.5, vx2), (0.5, vy2), (1.0, potential)]);
    }
    let function = graph.sum(0.0, &terms);
    model(graph, Kind::Lagrangian, n as usize, 1, function)
}

fn model(graph: Graph, kind: Kind, coordinates: usize, parameters: usize, function: Id) -> Model {
    let source = Source {
        graph,
        kind,
        coordinates,
        parameters,
        function,
        forces: vec![],
        dissipation: None,
        holonomic: vec![],
        nonholonomic: vec![],
    };
    Model::new(source).unwrap()
}

/// H = (p1² + p2²)/2 + (q1² + q2²)/2 + q1² q2 − q2³/3.
fn henon_heiles() -> Model {
    let mut graph = Graph::default();
    let [x, y, p, q] = [0, 1, 2, 3].map(|i| graph.variable(i));
    let [x2, y2, p2, q2] = [x, y, p, q].map(|id| graph.multiply(id, id));
    let (x2y, y3) = (graph.multiply(x2, y), graph.multiply(y2, y));
    let function =
        graph.sum(0.0, &[(0.5, p2), (0.5, q2), (0.5, x2), (0.5, y2), (1.0, x2y), (-1.0 / 3.0, y3)]);
    model(graph, Kind::Hamiltonian, 2, 0, function)
}

fn reached(model: &Model, y0: &[f64], parameters: &[f64], end: f64) -> Solution {
    let request = Request {
        integrator: Integrator::Gauss(gauss::method("gauss16").unwrap()),
        span: (0.0, end),
        rtol: 1e-12,
        atol: None,
        dt: None,
        max_step: None,
        max_steps: u64::MAX,
        outputs: Some(vec![end]),
        held: true,
        events: vec![],
        series: None,
    };
    let control = Control::default();
    solve(model, &request, (y0, parameters), &mut Ticker::quiet(&control)).unwrap()
}

#[test]
fn trajectories_are_those_of_two_hundred_bits() {
    type Case = (Model, Vec<f64>, Vec<f64>, f64, Vec<f64>);
    let cases: [Case; 2] = [
        (
            henon_heiles(),
            vec![0.1, 0.0, 0.0, 0.5],
            vec![],
            100.0,
            vec![
                -4.019_423_787_606_883e-2,
                6.790_169_217_720_216e-1,
                3.845_092_895_185_983e-2,
                4.859_483_155_300_364e-2,
            ],
        ),
        (
            chain(2),
            vec![0.5, 0.625, 0.0, 0.0],
            vec![9.81],
            10.0,
            vec![
                -1.212_015_956_120_125_6e-2,
                -1.378_120_270_758_944_1e-2,
                9.180_327_218_723_687e-1,
                1.850_548_009_466_752_6,
            ],
        ),
    ];
    for (model, y0, parameters, end, expected) in cases {
        let found = reached(&model, &y0, &parameters, end).y;
        for (x, y) in found.iter().zip(&expected) {
            // 11 and 3 times round-off are their conditioning.
            assert!((x - y).abs() < 2e-14, "{found:?}");
        }
    }
}

/// Of links in one line the first alone turns, and the others by rounding at first: no step is chosen by that.
#[test]
fn links_in_one_line_take_steps_as_others_do() {
    let model = chain(10);
    let y0: Vec<f64> = (0..20).map(|i| if i < 10 { 0.5 } else { 0.0 }).collect();
    for (end, most) in [(1e-3, 20), (1.0, 60)] {
        let steps = reached(&model, &y0, &[9.81], end).steps;
        assert!(steps <= most, "{steps} steps to {end}");
    }
}

/// The mass matrix of a chain is found on the graph: constant where it is, and no operation is left over.
#[test]
fn a_double_pendulum_takes_few_operations() {
    assert!(chain(2).code.operations() <= 30);
    assert!(chain(1).code.operations() <= 3);
    assert!(henon_heiles().code.operations() <= 5);
}

#[test]
fn only_models_with_functions_like_exp_look_for_what_is_narrow() {
    assert!(chain(2).narrow.is_none());
    assert!(henon_heiles().narrow.is_none());
    let mut graph = Graph::default();
    let [q, p] = [0, 1].map(|i| graph.variable(i));
    let (p2, wall) = (graph.multiply(p, p), graph.call(Function::Tanh, q));
    let function = graph.sum(0.0, &[(0.5, p2), (1.0, wall)]);
    assert!(model(graph, Kind::Hamiltonian, 1, 0, function).narrow.is_some());
}
