//! Every lower half keeps to the contract of [`LowerHalf`]: the STM32 board's on pins that are only recorded, and the
//! simulated leg.

use leg_firmware::board::timing::PWM_TOP;
use leg_firmware::board::{FaultLines, Gate, Half, LowerHalf, PowerPins, PowerStage, Turn};
use leg_firmware::drive::Drive;
use leg_firmware::sensors::Sensors;
use leg_host_tools::plant::{Plant, PlantSettings, Start};
use leg_host_tools::ready_rigs::READY_RIGS;
use leg_host_tools::rig_file::RigFile;
use std::error::Error;

/// A lower half whose outputs can be looked at.
trait Observed: LowerHalf {
    /// What the motors get after the last drive: the part of the supply, and the sign.
    fn outputs(&mut self) -> [f64; 3];

    /// Switches the outputs off as hardware does on a fault of a driver that is over at once.
    fn break_for_a_moment(&mut self);
}

/// Pins that are recorded, and a timer that takes over pulse widths at its update.
#[derive(Default)]
struct Recorder {
    set: [Half; 3],
    /// Pulse widths since the last update.
    live: [u16; 3],
    on: bool,
    broke: bool,
}

impl PowerPins for Recorder {
    fn set(&mut self, motor: usize, half: Half) {
        self.set[motor] = half;
    }

    fn switch(&mut self, on: bool) {
        self.on = on;
    }

    fn on(&self) -> bool {
        self.on
    }
}

/// The STM32 board without its registers.
struct Recorded(PowerStage<Recorder>);

impl LowerHalf for Recorded {
    fn sense(&mut self) -> Sensors {
        let lines = FaultLines {
            lost: self.0.lost(),
            driver_break: std::mem::take(&mut self.0.pins().broke),
            ..FaultLines::default()
        };
        Sensors {
            driver_fault: lines.faults().drivers,
            ..Sensors::default()
        }
    }

    fn drive(&mut self, drive: &Drive<f32>) {
        self.0.drive(drive);
    }

    fn cut(&mut self) {
        self.0.cut();
    }
}

impl Observed for Recorded {
    fn outputs(&mut self) -> [f64; 3] {
        let pins = self.0.pins();
        pins.live = pins.set.map(|half| half.compare);
        let on = f64::from(u8::from(pins.on));
        std::array::from_fn(|i| {
            let sign = if pins.set[i].forward { on } else { -on };
            sign * f64::from(pins.live[i]) / f64::from(PWM_TOP)
        })
    }

    fn break_for_a_moment(&mut self) {
        let pins = self.0.pins();
        pins.on = false;
        pins.broke = true;
    }
}

/// The simulated leg.
struct Simulated {
    plant: Plant,
    gate: Gate,
    on: bool,
    broke: bool,
}

impl Simulated {
    fn new() -> Result<Self, Box<dyn Error>> {
        let [table_1, ..] = &READY_RIGS;
        let rig = RigFile::parse(table_1.name, table_1.text)?;
        let settings = PlantSettings::default();
        let plant = Plant::new(&rig, &settings, Start::Slack { slack_m: 2e-3 }, 1)?;
        Ok(Self {
            plant,
            gate: Gate::default(),
            on: false,
            broke: false,
        })
    }
}

impl LowerHalf for Simulated {
    fn sense(&mut self) -> Sensors {
        let lines = FaultLines {
            driver_break: std::mem::take(&mut self.broke),
            ..FaultLines::default()
        };
        Sensors {
            driver_fault: lines.faults().drivers,
            ..self.plant.sense()
        }
    }

    fn drive(&mut self, drive: &Drive<f32>) {
        self.on = self.gate.step(drive.enabled, self.on) != Turn::Close;
        self.plant.step(&Drive {
            enabled: self.on,
            ..*drive
        });
    }

    fn cut(&mut self) {
        self.gate.cut();
        self.on = false;
    }
}

impl Observed for Simulated {
    fn outputs(&mut self) -> [f64; 3] {
        self.plant.truth().currents_a
    }

    fn break_for_a_moment(&mut self) {
        self.on = false;
        self.broke = true;
    }
}

/// Which way each motor is driven.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    Off,
    In,
    Out,
}

const OFF: [Way; 3] = [Way::Off; 3];

/// Less than this part of the supply, or current in A, is none.
const NOTHING: f64 = 0.01;

fn ways(board: &mut dyn Observed) -> [Way; 3] {
    board.outputs().map(|output| match output {
        _ if output > NOTHING => Way::In,
        _ if output < -NOTHING => Way::Out,
        _ => Way::Off,
    })
}

/// Several ticks of the same drive: enough for a bridge to turn and for a current to rise or to fade.
fn held(board: &mut dyn Observed, duty: [f32; 3], enabled: bool) -> [Way; 3] {
    for _ in 0..40 {
        board.sense();
        board.drive(&Drive { duty, enabled });
    }
    ways(board)
}

const DUTY: [f32; 3] = [0.4, -0.4, 0.0];
const DRIVEN: [Way; 3] = [Way::In, Way::Out, Way::Off];

type Named = (&'static str, Box<dyn Observed>);

fn boards() -> Result<[Named; 2], Box<dyn Error>> {
    let recorded = Recorded(PowerStage::new(Recorder::default(), PWM_TOP));
    Ok([
        ("recorder", Box::new(recorded)),
        ("simulation", Box::new(Simulated::new()?)),
    ])
}

#[test]
fn nothing_is_driven_before_an_enabled_drive() -> Result<(), Box<dyn Error>> {
    for (name, mut board) in boards()? {
        assert_eq!(ways(board.as_mut()), OFF, "{name}");
        assert_eq!(held(board.as_mut(), DUTY, false), OFF, "{name}");
        assert_eq!(held(board.as_mut(), DUTY, true), DRIVEN, "{name}");
        assert_eq!(held(board.as_mut(), DUTY, false), OFF, "{name}");
    }
    Ok(())
}

#[test]
fn a_duty_has_the_sign_of_the_pull() -> Result<(), Box<dyn Error>> {
    for motor in 0..3 {
        for (duty, way) in [(0.4, Way::In), (-0.4, Way::Out)] {
            for (name, mut board) in boards()? {
                let mut duties = [0.0; 3];
                duties[motor] = duty;
                let mut expected = OFF;
                expected[motor] = way;
                assert_eq!(held(board.as_mut(), duties, true), expected, "{name}");
            }
        }
    }
    Ok(())
}

#[test]
fn what_is_no_duty_is_bounded() -> Result<(), Box<dyn Error>> {
    for (name, mut board) in boards()? {
        let beyond = [f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
        assert_eq!(held(board.as_mut(), beyond, true), DRIVEN, "{name}");
        let outputs = board.outputs();
        assert!(outputs.iter().all(|output| output.is_finite()), "{name}");
    }
    Ok(())
}

#[test]
fn a_cut_lasts_until_the_drive_has_let_go() -> Result<(), Box<dyn Error>> {
    for (name, mut board) in boards()? {
        held(board.as_mut(), DUTY, true);
        board.cut();
        assert_eq!(held(board.as_mut(), DUTY, true), OFF, "{name}");
        assert_eq!(held(board.as_mut(), DUTY, false), OFF, "{name}");
        assert_eq!(held(board.as_mut(), DUTY, true), DRIVEN, "{name}");
    }
    Ok(())
}

#[test]
fn so_does_a_break_by_hardware_which_is_told() -> Result<(), Box<dyn Error>> {
    for (name, mut board) in boards()? {
        held(board.as_mut(), DUTY, true);
        board.break_for_a_moment();
        assert_eq!(board.sense().driver_fault, [true; 3], "{name}");
        assert_eq!(held(board.as_mut(), DUTY, true), OFF, "{name}");
        assert_eq!(held(board.as_mut(), DUTY, false), OFF, "{name}");
        assert_eq!(board.sense().driver_fault, [false; 3], "{name}");
        assert_eq!(held(board.as_mut(), DUTY, true), DRIVEN, "{name}");
    }
    Ok(())
}
