//! How hard a leg may be pushed.

use leg_model::{Distribution, Error, Rig, TensionBounds, distribute, inverse_kinematics};
use leg_rig::rig_file::RigFile;
use leg_sim::plant::Truth;
use nalgebra::Vector3;

/// How much farther than by a steady force the tensions go when it begins or ends.
const SWING: f64 = 1.2;

/// The strongest push along a direction that lets no tension leave its bounds, N.
pub(super) fn strongest_n(file: &RigFile, truth: &Truth, across: &Vector3<f64>) -> f64 {
    let change = || {
        let rig = Rig::new(&file.parameters)?;
        let kinematics = inverse_kinematics(rig.geometry(), &truth.direction)?;
        let plane = file.support.plane(&truth.direction);
        let bounds = TensionBounds::new(file.f_min_n, file.f_max_n)?;
        let moment = truth.tip_m.cross(across);
        distribute(&kinematics.moment_map, &plane, &moment, &bounds)
    };
    let Ok(change): Result<Distribution<f64, 3>, Error> = change() else {
        return 0.0;
    };
    let pairs = truth.tensions_n.iter().zip(&change.particular);
    let rooms = pairs.map(|(tension, per_newton)| {
        let room_n = (tension - file.f_min_n).min(file.f_max_n - tension);
        room_n / (SWING * per_newton.abs())
    });
    rooms.fold(f64::INFINITY, f64::min).max(0.0)
}
