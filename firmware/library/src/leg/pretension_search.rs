//! The turn of the search for the pretension.

use super::shared::Shared;
use leg_model::{Error, Scalar};

/// One step of the search for the pretension, at the last target. Where that is on its way to the one at which a stiffness is searched for, every
/// second one looks at its own tendons instead: there is no time for both.
#[inline(never)]
pub fn search_pretension<T: Scalar>(shared: &mut Shared<T>) -> Result<(), Error> {
    if let Some(target) = &shared.target {
        let (search, targets) = (&mut shared.pretension, &mut shared.targets);
        let on_its_way = search.is_far_from(target.pretension_n);
        if on_its_way && !search.take_turn() {
            return targets.set_stiffnesses_at(&shared.mechanism, &target.tensions_n);
        }
        let payload_kg = shared.estimator.load.payload_kg();
        let stiffnesses_n_per_m = search.step(&shared.mechanism, target, payload_kg)?;
        if !on_its_way {
            targets.set_stiffnesses(&stiffnesses_n_per_m);
        }
    }
    Ok(())
}
