//! The store on a flash that loses its power, its bits and its contents.

mod damage;
mod mock;
mod power;
mod records;
mod sizes;

use super::{CorruptReason, Loaded, Store, StoreError};
use crate::settings::{
    AxisCalibration, BoardCalibration, CurrentOutputs, Settings, TendonParameters,
};
use core::ops::Range;
use embassy_futures::block_on;
use leg_model::{CURVE_POINTS_MAX, CurvePoint, JointStiffness, RigParameters, SupportKind};
use mock::{FlashFailure, Mock};

type Outcome<T> = Result<T, StoreError<FlashFailure>>;

fn store(flash: &mut Mock) -> Store<&mut Mock> {
    let range = flash.range();
    match Store::new(flash, range) {
        Ok(store) => store,
        Err(error) => panic!("{error}"),
    }
}

fn load(flash: &mut Mock) -> Outcome<Loaded> {
    block_on(store(flash).load())
}

fn save(flash: &mut Mock, settings: &Settings) -> Outcome<()> {
    block_on(store(flash).save(settings))
}

fn clear(flash: &mut Mock) -> Outcome<()> {
    block_on(store(flash).clear())
}

/// Saves and reads back.
#[track_caller]
fn keep(flash: &mut Mock, settings: &Settings) {
    assert_eq!(save(flash, settings), Ok(()));
    assert_holds(flash, settings);
}

#[track_caller]
fn assert_holds(flash: &mut Mock, settings: &Settings) {
    assert_eq!(load(flash), Ok(Loaded::Settings(settings.clone())));
}

/// Settings that differ from others by their number.
fn small(number: usize) -> Settings {
    let joint = JointStiffness {
        bending_nm_per_rad: 0.5,
        torsion_nm_per_rad: 0.25,
        axial_compliance_m_per_n: 1e-7,
    };
    let axis = AxisCalibration {
        m_per_count: -1e-7,
        unstretched_at_zero_m: Some(0.2),
        cell_n_per_code: 0.05,
        cell_zero_code: 400.0,
        current_a_per_code: 0.005,
    };
    Settings {
        rig: RigParameters {
            base_anchors_m: [[0.1, 0.0], [-0.05, 0.09], [-0.05, -0.09]],
            leg_anchors_m: [[0.05, 0.0], [-0.02, 0.04], [-0.02, -0.04]],
            upper_length_m: 0.2,
            joint_length_m: 0.02,
            leg_length_m: 0.3,
            leg_mass_kg: 0.4,
            leg_centroid_m: 0.15,
            gravity_m_per_s2: 9.81,
        },
        support: SupportKind::ElasticUniversal,
        joint,
        tendons: [const { TendonParameters::Constant(5e4) }; 3],
        f_min_n: 5.0,
        f_max_n: 100.0,
        pretension_n: 10.0 + 0.1 * number as f32,
        tilt_max_sine: 0.4,
        axes: [axis; 3],
        current_outputs: CurrentOutputs::default(),
        board: BoardCalibration {
            supply_v_per_code: 0.01,
            temperature_c_per_code: 0.05,
            temperature_at_zero_c: -40.0,
        },
        motion: Default::default(),
        servos: Default::default(),
        estimation: Default::default(),
        limits: Default::default(),
        homing: Default::default(),
        keeps_station: true,
        recorded: Default::default(),
    }
}

/// The same with as much in it as fits.
fn large(number: usize) -> Settings {
    let points = (0..CURVE_POINTS_MAX).map(|i| CurvePoint {
        tension_n: 10.0 * i as f32,
        elongation_m: 1e-4 * i as f32,
        stiffness_n_per_m: 5e4 + number as f32,
    });
    let curve = TendonParameters::Curve(points.collect());
    Settings {
        tendons: [curve.clone(), curve.clone(), curve],
        ..small(number)
    }
}

/// Small ones and large ones by turns.
fn mixed(number: usize) -> Settings {
    match number % 3 {
        0 => small(number),
        _ => large(number),
    }
}

#[test]
fn a_blank_flash_is_empty() {
    let mut flash = Mock::new(3);
    assert_eq!(load(&mut flash), Ok(Loaded::Empty));
    assert_eq!(flash.steps, 0, "reading does not write");
}

#[test]
fn the_newest_settings_are_loaded() {
    let mut flash = Mock::new(3);
    for number in 0..40 {
        keep(&mut flash, &mixed(number));
    }
}

#[test]
fn one_store_saves_and_loads_many_times() {
    let mut flash = Mock::new(3);
    let mut store = store(&mut flash);
    for number in 0..40 {
        assert_eq!(block_on(store.save(&mixed(number))), Ok(()));
        let loaded = block_on(store.load());
        assert_eq!(loaded, Ok(Loaded::Settings(mixed(number))));
    }
}

#[test]
fn cleared_settings_do_not_come_back() {
    let mut flash = Mock::new(3);
    for number in 0..20 {
        keep(&mut flash, &mixed(number));
        assert_eq!(clear(&mut flash), Ok(()));
        assert_eq!(load(&mut flash), Ok(Loaded::Empty));
    }
}

#[test]
fn every_page_is_erased_alike() {
    let mut flash = Mock::new(8);
    for number in 0..160 {
        assert_eq!(save(&mut flash, &large(number)), Ok(()));
    }
    // The first erase of each page makes sure that it is one.
    let (least, most) = (flash.erases.iter().min(), flash.erases.iter().max());
    assert_eq!((least, most), (Some(&20), Some(&21)));
}

#[test]
fn refused_settings_are_not_written() {
    let mut flash = Mock::new(3);
    keep(&mut flash, &small(1));
    let steps = flash.steps;
    let mut refused = small(2);
    refused.axes[1].m_per_count = 0.0;
    let error = match refused.check() {
        Err(error) => error,
        Ok(()) => panic!("a scale of zero is refused"),
    };
    assert_eq!(save(&mut flash, &refused), Err(StoreError::Settings(error)));
    assert_eq!(flash.steps, steps);
    assert_holds(&mut flash, &small(1));
}

#[test]
fn a_region_is_whole_pages_inside_the_flash() {
    let backwards = Range {
        start: 4096,
        end: 0,
    };
    for range in [
        0..2048,
        0..4096,
        0..6143,
        8..4104,
        4096..12288,
        backwards,
        0..0,
    ] {
        let mut flash = Mock::new(4);
        let refused = Store::new(&mut flash, range.clone()).map(|_| ());
        assert_eq!(refused, Err(StoreError::Region), "{range:?}");
    }
}

#[test]
fn what_lies_beside_the_region_stays() {
    let mut flash = Mock::new(5);
    for range in [0..2048, 4 * 2048..5 * 2048] {
        flash.bytes[range].fill(0x5A);
    }
    flash.restart();
    for number in 0..20 {
        let Ok(mut store) = Store::new(&mut flash, 2048..4 * 2048) else {
            panic!("three pages inside the flash")
        };
        assert_eq!(block_on(store.save(&large(number))), Ok(()));
    }
    assert!(flash.bytes[..2048].iter().all(|&byte| byte == 0x5A));
    assert!(flash.bytes[4 * 2048..].iter().all(|&byte| byte == 0x5A));
}
