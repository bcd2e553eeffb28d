//! The settings that are built into the firmware are those of the default rig file.
//!
//! `LEG_WRITE_DEFAULTS=1 cargo test --package leg-tests --test suite default_settings` writes them anew.

use leg_firmware::leg::Leg;
use leg_firmware::settings::Settings;
use leg_rig::control_settings::settings;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use std::error::Error;
use std::path::Path;

const BLOB: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../firmware/library/src/settings/default.postcard"
);

/// What the blob should hold.
fn expected() -> Result<Settings, Box<dyn Error>> {
    let [table_1, ..] = &READY_RIGS;
    let rig = RigFile::parse(table_1.name, table_1.text)?;
    Ok(settings(&rig, &rig.gains, None))
}

#[test]
fn the_blob_is_up_to_date() -> Result<(), Box<dyn Error>> {
    let mut bytes = [0; 2048];
    let bytes = postcard::to_slice(&expected()?, &mut bytes)?;
    if std::env::var_os("LEG_WRITE_DEFAULTS").is_some() {
        std::fs::write(Path::new(BLOB), &bytes)?;
    }
    let blob = std::fs::read(BLOB)?;
    assert!(
        blob == *bytes,
        "{BLOB} is not what the rig file gives; write it anew with LEG_WRITE_DEFAULTS=1"
    );
    Ok(())
}

#[test]
fn a_leg_starts_with_the_built_in_settings() -> Result<(), Box<dyn Error>> {
    let built_in = Settings::table_1().ok_or("the blob has another shape")?;
    assert_eq!(built_in, expected()?);
    assert_eq!(built_in, built_in.unhomed());
    Leg::<f32>::new(&built_in)?;
    Ok(())
}
