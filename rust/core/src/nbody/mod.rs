pub mod kepler;
