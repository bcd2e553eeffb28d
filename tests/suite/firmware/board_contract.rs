//! Every lower half that runs here keeps to the contract of [`LowerHalf`]: the STM32 board's power stage on pins that are
//! only recorded, the virtual board with the simulated leg, and the virtual board inside QEMU.

use leg_firmware::board::timing::PWM_TOP;
use leg_firmware::board::{BridgeOutput, FaultLines, LowerHalf, PowerPins, PowerStage};
use leg_firmware::drive::Drive;
use leg_firmware::sensors::Sensors;
use leg_firmware::settings::Settings;
use leg_firmware_bench::protocol::{BoardReply, BoardStep, Reply, Request};
use leg_firmware_bench::virtual_board::VirtualBoard;
use leg_rig::plant_settings::PlantSettings;
use leg_rig::rig_file::RigFile;
use leg_sim::link::Link;
use leg_sim::plant::{Defect, Plant, Start};
use std::error::Error;

const DRIVER_FAULT: Defect = Defect::DriverFault(0);

/// A lower half whose outputs can be read.
trait Observed: LowerHalf {
    /// What the motors get after the last drive: the part of the supply, and the sign.
    fn outputs(&mut self) -> [f64; 3];

    /// Lets a driver raise its fault line, and drop it after the next reading.
    fn break_for_a_moment(&mut self);
}

/// Pins that are recorded, and a timer that takes over pulse widths at its update.
#[derive(Default)]
struct Recorder {
    set: [BridgeOutput; 3],
    /// Pulse widths since the last update.
    live: [u16; 3],
    on: bool,
    broke: bool,
}

impl PowerPins for Recorder {
    fn set(&mut self, motor: usize, half: BridgeOutput) {
        self.set[motor] = half;
    }

    fn switch(&mut self, on: bool) {
        self.on = on;
    }

    fn is_on(&self) -> bool {
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

/// The virtual board in this process and the simulated leg on it, as `--on sim` has them.
struct Simulated {
    board: VirtualBoard,
    plant: Plant,
}

impl Simulated {
    fn new() -> Result<Self, Box<dyn Error>> {
        let rig = RigFile::load(None)?;
        let settings = PlantSettings::default();
        let plant = Plant::new(&rig, &settings, Start::Slack { slack_mm: 2.0 }, 1)?;
        Ok(Self {
            board: VirtualBoard::default(),
            plant,
        })
    }
}

impl LowerHalf for Simulated {
    fn sense(&mut self) -> Sensors {
        self.board.read(&self.plant.sense());
        self.plant.set_defect(DRIVER_FAULT, false);
        self.board.sense()
    }

    fn drive(&mut self, drive: &Drive<f32>) {
        self.board.drive(drive);
        self.plant.step(&self.board.motors());
    }

    fn cut(&mut self) {
        self.board.cut();
    }
}

impl Observed for Simulated {
    fn outputs(&mut self) -> [f64; 3] {
        self.plant.truth().currents_a
    }

    fn break_for_a_moment(&mut self) {
        self.plant.set_defect(DRIVER_FAULT, true);
    }
}

/// The virtual board inside QEMU, behind its link.
struct OnQemu {
    link: Box<dyn Link>,
    broke: bool,
    motors: Drive<f32>,
}

impl OnQemu {
    fn new() -> Result<Self, Box<dyn Error>> {
        let mut link = Box::new(crate::common::qemu()?);
        let settings = Settings::table_1().ok_or("no built-in settings")?;
        link.ask(&Request::Start(settings))?;
        let off = Drive {
            duty: [0.0; 3],
            enabled: false,
        };
        Ok(Self {
            link,
            broke: false,
            motors: off,
        })
    }

    fn step(&mut self, step: BoardStep) -> Sensors {
        match self.link.ask(&Request::Board(step)) {
            Ok(Reply::Board(BoardReply { sensors, motors })) => {
                self.motors = motors;
                sensors
            }
            other => panic!("{other:?}"),
        }
    }
}

impl LowerHalf for OnQemu {
    fn sense(&mut self) -> Sensors {
        let broke = std::mem::take(&mut self.broke);
        self.step(BoardStep::Read(Sensors {
            driver_fault: [broke, false, false],
            ..Sensors::default()
        }))
    }

    fn drive(&mut self, drive: &Drive<f32>) {
        self.step(BoardStep::Drive(*drive));
    }

    fn cut(&mut self) {
        self.step(BoardStep::Cut);
    }
}

impl Observed for OnQemu {
    fn outputs(&mut self) -> [f64; 3] {
        let on = f64::from(u8::from(self.motors.enabled));
        self.motors.duty.map(|duty| on * f64::from(duty))
    }

    fn break_for_a_moment(&mut self) {
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

fn boards() -> Result<[Named; 3], Box<dyn Error>> {
    let recorded = Recorded(PowerStage::new(Recorder::default(), PWM_TOP));
    Ok([
        ("recorder", Box::new(recorded)),
        ("simulation", Box::new(Simulated::new()?)),
        ("QEMU", Box::new(OnQemu::new()?)),
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
fn so_does_a_break_by_hardware_which_is_reported() -> Result<(), Box<dyn Error>> {
    for (name, mut board) in boards()? {
        held(board.as_mut(), DUTY, true);
        board.break_for_a_moment();
        assert!(board.sense().driver_fault.contains(&true), "{name}");
        assert_eq!(held(board.as_mut(), DUTY, true), OFF, "{name}");
        assert_eq!(held(board.as_mut(), DUTY, false), OFF, "{name}");
        assert_eq!(board.sense().driver_fault, [false; 3], "{name}");
        assert_eq!(held(board.as_mut(), DUTY, true), DRIVEN, "{name}");
    }
    Ok(())
}
