//! The chip's recorder: what its control interrupt has written is read by a host over the serial line.

use crate::common::chip::{
    MS, Outcome, findings, identity, reply, resting_tick, send, started, vary_cells,
};
use leg_firmware::host_link::{HostReply, HostRequest};
use leg_firmware::recorder::{
    READ_MAX, RecordedFault, RecorderReply, RecorderReport, RecorderRequest, RecorderState,
};
use leg_firmware::sensors::CODE_MAX;
use leg_firmware::settings::RecordedSignal;
use leg_firmware::settings::Settings;
use leg_firmware::supervisor::{Fault, FaultSet};
use leg_firmware_bench::protocol::Request;
use leg_sim::link::Link;
use std::error::Error;
use stm32g474_emulator::chip::Chip;

fn ask(chip: &mut Chip, request: RecorderRequest) -> Result<RecorderReply, Box<dyn Error>> {
    send(chip, &HostRequest::Recorder(request))?;
    reply(chip, |reply| match reply {
        HostReply::Recorder(answer) => Some(answer),
        _ => None,
    })
}

fn report(chip: &mut Chip, request: RecorderRequest) -> Result<RecorderReport, Box<dyn Error>> {
    match ask(chip, request)? {
        RecorderReply::Report(report) => Ok(report),
        RecorderReply::Triples(_) => Err("triples".into()),
    }
}

#[test]
fn a_chip_keeps_the_ticks_before_its_fault() -> Outcome {
    let mut session = started(100)?;
    for tick in 0..500 {
        let mut request = resting_tick();
        // Constant codes are a fault.
        for code in &mut request.sensors.cell_codes {
            *code += 2 * (tick / 8 % 2);
        }
        request.sensors.emergency_stop = tick >= 60;
        session.ask(&Request::Tick(request))?;
    }
    let chip = session.chip().ok_or("no chip")?;
    vary_cells(chip);
    identity(chip)?;
    let report = report(chip, RecorderRequest::Stop)?;
    assert_eq!(report.state, RecorderState::Faulted);
    let RecordedFault { tick, faults } = report.fault.ok_or("no fault")?;
    assert_eq!(faults, FaultSet::single(Fault::EmergencyStop));
    // The fault's tick is the first of a quarter of all rows.
    assert_eq!(report.tick - tick, 399);
    assert!((150..=170).contains(&tick), "{tick}");
    assert_eq!(
        u32::from(report.rows),
        report.tick,
        "all ticks since the start"
    );
    let first = report.rows * report.signals.len() as u16 - READ_MAX as u16;
    let RecorderReply::Triples(read) = ask(chip, RecorderRequest::Read(first))? else {
        return Err("no triples".into());
    };
    assert_eq!(read.len(), READ_MAX);
    let settings = Settings::table_1().ok_or("no built-in settings")?;
    let code = f32::from(CODE_MAX / 4) - settings.axes[0].cell_zero_code;
    let [tensions, pulled, duties] = [2, 1, 0].map(|back| read[READ_MAX - 1 - back]);
    for step in tensions {
        assert!((f32::from(step) - code / 2.0).abs() <= 2.0, "{step}");
    }
    assert_eq!([pulled, duties], [[0; 3]; 2]);
    let newest = RecordedSignal::Tensions as usize;
    assert_eq!(report.newest[newest].map(|step| step as u16), tensions);
    chip.run(chip.cycle() + MS);
    assert_eq!(findings(chip), [""; 0]);
    Ok(())
}
