//! The model at many poses, on all cores, without Python.

use crate::outputs::{NONLINEAR, Output, Whole};
use leg_model::{Error, Query, Rig, RigParameters, StiffnessDemand, evaluate, evaluate_for_map};
use leg_model_tools::line_error::LineError;
use leg_model_tools::nonlinear;
use rayon::prelude::*;

/// Poses that one core takes at a time: about half a millisecond.
const CHUNK: usize = 512;

/// An argument: the same for all poses, or one number each.
pub enum Argument {
    /// The same for all.
    One(f64),
    /// One each.
    Each(Vec<f64>),
}

impl Argument {
    fn value(&self, pose: usize) -> f64 {
        match self {
            Self::One(value) => *value,
            Self::Each(values) => values.get(pose).copied().unwrap_or(f64::NAN),
        }
    }
}

/// Puts a number into a query.
pub type Put = fn(&mut Query<f64>, f64);

/// What may differ from pose to pose, and where it goes.
pub struct Varying {
    /// The numbers.
    pub argument: Argument,
    /// Puts one into the query.
    pub put: Put,
}

/// Where a demanded stiffness goes.
pub fn put_demand(query: &mut Query<f64>, stiffness_nm_per_rad: f64) {
    query.demand = Some(StiffnessDemand {
        stiffness_nm_per_rad,
        towards_rad: query.demand.and_then(|demand| demand.towards_rad),
    });
}

/// Where its azimuth goes.
pub fn put_demand_towards(query: &mut Query<f64>, deg: f64) {
    if let Some(demand) = &mut query.demand {
        demand.towards_rad = Some(deg.to_radians());
    }
}

/// Poses to evaluate.
pub struct Poses {
    /// The mechanism.
    pub parameters: RigParameters<f64, 3>,
    /// What is the same for all.
    pub query: Query<f64>,
    /// What differs.
    pub varying: Vec<Varying>,
    /// What is asked for.
    pub outputs: Vec<&'static Output>,
    /// How many.
    pub count: usize,
}

/// A pose without a result: its number, and why.
pub type NoResult = (usize, Error);

/// What is wrong at a pose, with the argument's name and what to do.
pub fn words(error: Error) -> String {
    LineError::from(error).to_string()
}

impl Poses {
    /// Evaluates them into one array for each output, row by row. What has no result is not a number, and is listed.
    ///
    /// # Errors
    /// A mechanism that is refused.
    pub fn evaluate(&self, arrays: &mut [Vec<f64>]) -> Result<Vec<NoResult>, Error> {
        let rig = Rig::new(&self.parameters)?;
        let mut pieces: Vec<Vec<&mut [f64]>> = Vec::new();
        pieces.resize_with(self.count.div_ceil(CHUNK), Vec::new);
        for (array, output) in arrays.iter_mut().zip(&self.outputs) {
            let rows = array.chunks_mut(CHUNK * width(output));
            for (piece, rows) in pieces.iter_mut().zip(rows) {
                piece.push(rows);
            }
        }
        let numbered = pieces.into_par_iter().enumerate();
        let failed = numbered.flat_map_iter(|(number, mut piece)| {
            self.evaluate_piece(&rig, number * CHUNK, &mut piece)
        });
        Ok(failed.collect())
    }

    fn evaluate_piece(
        &self,
        rig: &Rig<f64, 3>,
        first: usize,
        arrays: &mut [&mut [f64]],
    ) -> Vec<NoResult> {
        // It carries three whole curves: not to be made for each pose.
        let mut query = self.query;
        let of_map: Option<Vec<_>> = self.outputs.iter().map(|output| output.map).collect();
        let mut failed = Vec::new();
        for pose in first..self.count.min(first + CHUNK) {
            for varying in &self.varying {
                (varying.put)(&mut query, varying.argument.value(pose));
            }
            let rows = arrays.iter_mut().zip(&self.outputs).map(|(array, output)| {
                let begin = (pose - first) * width(output);
                &mut array[begin..begin + width(output)]
            });
            let result = match &of_map {
                Some(of_map) if query.demand.is_none() => {
                    evaluate_for_map(rig, &query).and_then(|found| {
                        let mut rows = of_map.iter().zip(rows);
                        rows.try_for_each(|(write, row)| write(&found, row))
                    })
                }
                _ => self.whole(&query).map(|found| {
                    for (output, row) in self.outputs.iter().zip(rows) {
                        (output.whole)(&found, row);
                    }
                }),
            };
            if let Err(error) = result {
                failed.push((pose, error));
                for (array, output) in arrays.iter_mut().zip(&self.outputs) {
                    let begin = (pose - first) * width(output);
                    array[begin..begin + width(output)].fill(f64::NAN);
                }
            }
        }
        failed
    }

    fn whole(&self, query: &Query<f64>) -> Result<Whole, Error> {
        let found = evaluate(&self.parameters, query)?;
        let nonlinear = self.outputs.iter().any(|output| output.name == NONLINEAR);
        let deviation_nonlinear_m = if nonlinear {
            nonlinear::deviation_m(&self.parameters, query)?
        } else {
            None
        };
        Ok(Whole {
            found,
            deviation_nonlinear_m,
        })
    }
}

/// How many numbers an output has for a pose.
pub fn width(output: &Output) -> usize {
    output.shape.iter().product()
}
