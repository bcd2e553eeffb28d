//! Power that fails at every step of a save, and what is found afterwards.

use super::mock::{FlashFailure, Mock, Random, TEARS, Tear};
use super::{
    CorruptReason, Loaded, StoreError, assert_holds, clear, keep, large, load, mixed, save, small,
};
use crate::settings::Settings;

const CUT: Result<(), StoreError<FlashFailure>> = Err(StoreError::Flash(FlashFailure::PowerCut));

/// How many words are written and pages erased.
fn steps(flash: &Mock, work: impl Fn(&mut Mock)) -> usize {
    let mut whole = flash.clone();
    work(&mut whole);
    whole.steps - flash.steps
}

/// The flash after the power failed in a save.
fn cut_save(flash: &Mock, settings: &Settings, cut: usize, tear: Tear, seed: u64) -> Mock {
    let mut torn = flash.clone();
    torn.cut_after(cut, tear, seed);
    assert_eq!(save(&mut torn, settings), CUT);
    torn.restart();
    torn
}

/// The same from several seeds if the power fails in an erase, which leaves more of a choice than a word.
fn cut_saves(flash: &Mock, settings: &Settings, cut: usize, tear: Tear) -> Vec<Mock> {
    let cut_save = |seed| cut_save(flash, settings, cut, tear, seed);
    let first = cut_save(cut as u64);
    let seeds = if first.is_page_torn { 50 } else { 0 };
    (0..seeds).map(cut_save).chain([first]).collect()
}

/// Which of the settings are loaded, twice alike.
#[track_caller]
fn load_old_or_new<'a>(flash: &mut Mock, old: &'a Settings, new: &'a Settings) -> &'a Settings {
    let found = match load(flash) {
        Ok(Loaded::Settings(settings)) if settings == *old => old,
        Ok(Loaded::Settings(settings)) if settings == *new => new,
        Ok(Loaded::Settings(settings)) => {
            panic!("pretension {} N is neither", settings.pretension_n)
        }
        other => panic!("neither old nor new: {other:?}"),
    };
    assert_holds(flash, found);
    found
}

/// Cuts each of many saves at every step; every page is erased meanwhile. Returns how many cuts left old and new.
fn cut_every_save(pages: usize, settings: fn(usize) -> Settings, tear: Tear) -> [usize; 2] {
    let mut flash = Mock::new(pages);
    keep(&mut flash, &settings(0));
    let mut found = [0; 2];
    for number in 1..=4 * pages {
        let (old, new) = (settings(number - 1), settings(number));
        for cut in 0..steps(&flash, |flash| keep(flash, &new)) {
            for mut torn in cut_saves(&flash, &new, cut, tear) {
                let is_new = *load_old_or_new(&mut torn, &old, &new) == new;
                found[usize::from(is_new)] += 1;
                keep(&mut torn, &settings(number + 1));
                keep(&mut torn, &settings(number + 2));
            }
        }
        keep(&mut flash, &new);
    }
    assert!(flash.erases.iter().all(|&erases| erases > 1));
    found
}

#[test]
fn a_cut_save_leaves_old_or_new() {
    for tear in TEARS {
        let [old, new] = cut_every_save(3, large, tear);
        // Only a last step that is done can have left the new ones.
        let is_done = matches!(tear, Tear::After);
        assert!(old > 1000 && (new > 0 || !is_done), "{tear:?}: {old} {new}");
    }
}

#[test]
fn a_cut_save_of_small_settings_leaves_old_or_new() {
    for tear in TEARS {
        cut_every_save(3, small, tear);
        cut_every_save(3, mixed, tear);
    }
}

#[test]
fn a_first_save_that_is_cut_leaves_no_settings_or_new_ones() {
    let blank = Mock::new(3);
    let new = large(1);
    for tear in TEARS {
        for cut in 0..steps(&blank, |flash| keep(flash, &new)) {
            let mut torn = cut_save(&blank, &new, cut, tear, cut as u64);
            match load(&mut torn) {
                Ok(Loaded::Settings(settings)) => assert_eq!(settings, new),
                Ok(Loaded::Empty | Loaded::Corrupt(CorruptReason::Storage)) => {}
                other => panic!("{tear:?} {cut}: {other:?}"),
            }
            keep(&mut torn, &new);
        }
    }
}

#[test]
fn power_may_fail_again_and_again() {
    for seed in 0..20 {
        let mut random = Random(seed);
        let mut flash = Mock::new(3 + seed as usize % 3);
        let mut kept = mixed(0);
        keep(&mut flash, &kept);
        for number in 1..300 {
            // Some of the cuts come after the save, within the load.
            let cut = random.number_below(200);
            let tear = TEARS[random.number_below(TEARS.len())];
            flash.cut_after(cut, tear, random.next());
            let new = mixed(number);
            let saved = save(&mut flash, &new);
            assert!(saved == Ok(()) || saved == CUT, "{saved:?}");
            let _ = load(&mut flash);
            flash.restart();
            let found = load_old_or_new(&mut flash, &kept, &new).clone();
            assert!(saved == CUT || found == new, "a save that was done is lost");
            kept = found;
        }
        keep(&mut flash, &mixed(300));
    }
}

#[test]
fn a_clearing_that_is_cut_leaves_old_settings_or_none() {
    for tear in TEARS {
        let mut flash = Mock::new(3);
        for number in 0..8 {
            let old = large(number);
            keep(&mut flash, &old);
            let work = |flash: &mut Mock| assert_eq!(clear(flash), Ok(()));
            for cut in 0..steps(&flash, work) {
                let mut torn = flash.clone();
                torn.cut_after(cut, tear, cut as u64);
                assert_eq!(clear(&mut torn), CUT);
                torn.restart();
                match load(&mut torn) {
                    Ok(Loaded::Settings(settings)) => assert_eq!(settings, old),
                    other => assert_eq!(other, Ok(Loaded::Empty), "{tear:?} {cut}"),
                }
                keep(&mut torn, &large(number + 1));
            }
        }
    }
}
