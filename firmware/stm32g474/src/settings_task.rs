//! The task that keeps settings in flash.
//!
//! It works on the second bank while programs run from the first, so the control interrupt goes on. A host gets the answer that
//! its settings were kept only after they were read back and are equal.

use crate::check_ins::CHECK_INS;
use crate::flash::CheckedFlash;
use core::fmt::Display;
use core::sync::atomic::{AtomicBool, Ordering};
use embassy_stm32::flash::Error;
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::signal::Signal;
use embassy_time::{Duration, with_timeout};
use leg_firmware::board::{CheckIns, WatchedTask};
use leg_firmware::settings::Settings;
use leg_firmware::store::{Loaded, REGION, Store, StoreError};

/// Settings to keep. Their place is handed over, because copying them would mask the control interrupt for 1 600 cycles.
pub static TO_SAVE: Signal<CriticalSectionRawMutex, &'static mut Settings> = Signal::new();

/// Whether they were kept, and their place back.
pub static SAVED: Signal<CriticalSectionRawMutex, (bool, &'static mut Settings)> = Signal::new();

/// Whether there were no whole settings at the start, and none have been kept since.
static CORRUPT: AtomicBool = AtomicBool::new(false);

/// The store on this chip's flash.
pub type BoardStore = Store<CheckedFlash>;

/// Whether other settings are used than those that were kept.
#[inline(always)]
pub fn corrupt() -> bool {
    CORRUPT.load(Ordering::Relaxed)
}

/// The store, unread.
///
/// # Errors
/// [`StoreError::Region`], which the region of this chip excludes.
pub fn store(flash: CheckedFlash) -> Result<BoardStore, StoreError<Error>> {
    Store::new(flash, REGION)
}

/// Puts the settings that were kept into a place. Where there are none the place stays as it is and the fault is raised: the leg
/// is not driven until settings have been kept anew. A board that was never set counts as such.
pub async fn load(store: &mut BoardStore, place: &mut Settings) {
    match store.load().await {
        Ok(Loaded::Settings(settings)) => {
            *place = settings;
            return;
        }
        Ok(Loaded::Empty) => defmt::warn!("no settings are kept"),
        Ok(Loaded::Corrupt(why)) => warn(&why),
        Err(error) => warn(&error),
    }
    refuse();
}

/// The settings that were kept are of no use.
pub fn refuse() {
    CORRUPT.store(true, Ordering::Relaxed);
}

/// Logs what is wrong with settings.
// Apart, because formatting numbers takes stack.
#[inline(never)]
pub fn warn(why: &dyn Display) {
    defmt::warn!("settings: {}", defmt::Display2Format(why));
}

/// Keeps what it is asked to keep, for ever.
#[embassy_executor::task]
pub async fn keep_settings(mut store: BoardStore) {
    let round = Duration::from_millis(CheckIns::PERIOD_MS);
    loop {
        CHECK_INS.check_in(WatchedTask::Settings);
        if let Ok(settings) = with_timeout(round, TO_SAVE.wait()).await {
            let kept = save(&mut store, settings).await;
            if kept {
                CORRUPT.store(false, Ordering::Relaxed);
            }
            SAVED.signal((kept, settings));
        }
    }
}

async fn save(store: &mut BoardStore, settings: &Settings) -> bool {
    if let Err(error) = store.save(settings).await {
        warn(&error);
        return false;
    }
    matches!(store.load().await, Ok(Loaded::Settings(kept)) if kept == *settings)
}
