//! The f64 model at work: nonlinear equilibrium, maps, tendon curves, exports and charts.

pub mod jsonl;
pub mod map_csv;
pub mod mjcf;
pub mod nonlinear;
pub mod plain_vectors;
pub mod plot;
pub mod tensile;
pub mod workspace_map;
