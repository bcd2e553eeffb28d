//! The lines to the host.

use super::runs::{answering_on_can, moving};
use super::{Mistake, mistakes};

const fn can(right: &'static str, wrong: &'static str, report: &'static str) -> Mistake {
    Mistake::new(
        "firmware/stm32g474/src/can_bus.rs",
        right,
        wrong,
        answering_on_can,
        report,
    )
}

mistakes! {
    another_baud_rate: Mistake {
        file: "firmware/stm32g474/src/serial.rs",
        right: "BAUD: u32 = 921_600;",
        wrong: "BAUD: u32 = 460_800;",
        run: moving,
        report: "LPUART1_BRR: it sends and receives at",
    };
    can_bits_of_another_length: can(
        "NOMINAL: [u8; 3] = [127, 42, 42];",
        "NOMINAL: [u8; 3] = [63, 21, 21];",
        "FDCAN2_NBTP and FDCAN2_DBTP give 2000000 and 5000000 bit/s, the bus has 1000000 and 5000000 bit/s",
    );
    can_data_bits_of_another_length: can(
        "DATA: [u8; 3] = [25, 8, 8];",
        "DATA: [u8; 3] = [27, 8, 8];",
        "FDCAN2_NBTP and FDCAN2_DBTP give 1000000 and 4722222 bit/s, the bus has 1000000 and 5000000 bit/s",
    );
    can_bits_sampled_late: can(
        "NOMINAL: [u8; 3] = [127, 42, 42];",
        "NOMINAL: [u8; 3] = [135, 34, 34];",
        "FDCAN2_NBTP: it samples at 800 ns the bit in which others change the rate, and which ends at 800 ns",
    );
    can_delay_not_compensated: can(
        "    registers.dbtp().modify(|w| w.set_tdc(true));\n",
        "    registers.dbtp().modify(|w| w.set_tdc(false));\n",
        "FDCAN2_DBTP: TDC is off",
    );
    can_filter_of_another_leg: can(
        "Identifier::received_by(leg)",
        "Identifier::received_by(LegAddress::ALL[3])",
        "FDCAN2 keeps no frame that is meant for it",
    );
    can_filter_lets_all_pass: can(
        "GlobalFilter::reject_all()",
        "GlobalFilter::default()",
        "FDCAN2 keeps a frame to another leg",
    );
}
