use nalgebra::Vector3;
#[derive(Clone, Debug)]
pub struct KeplerOrbit;
impl KeplerOrbit {
    pub fn new(_mu: f64, _position: Vector3<f64>, _velocity: Vector3<f64>) -> crate::Result<Self> {
        Ok(Self)
    }
    pub fn state(&self, _t: f64) -> (Vector3<f64>, Vector3<f64>) {
        (Vector3::zeros(), Vector3::zeros())
    }
}
