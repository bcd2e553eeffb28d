//! Double words with wrong bits.

use super::*;

#[test]
fn a_damaged_double_word_asks_for_an_nmi_and_names_its_bank() {
    let mut bench = bench(true, 1);
    bench.device.load(PAGE, &[7; 16]);
    bench.device.damage(PAGE + 12);
    assert_eq!(bench.word_at(PAGE), 0x0707_0707);
    assert!(!bench.device.nmi());
    assert_eq!(bench.word_at(PAGE + 8), 0x0707_0707);
    assert!(bench.device.nmi());
    let eccr = bench.read("ECCR");
    let value = |name| bench.device.registers.field("ECCR", name).extract(eccr);
    let [detected, bank, address] = ["ECCD", "BK_ECC", "ADDR_ECC"].map(value);
    assert_eq!((detected, bank, address), (1, 1, 0x3_c008));
    bench.write("ECCR", eccr);
    assert_eq!(bench.read("ECCR") & !(0x3f_ffff), 0);
    assert!(!bench.device.nmi());
    bench.word_at(PAGE + 12);
    assert!(bench.device.nmi());
}

/// Until the flags are cleared the place stays that of the first error, which may be a corrected one.
#[test]
fn the_place_of_an_error_is_that_of_the_first_one() {
    let mut bench = bench(true, 1);
    bench.device.weaken(START);
    bench.device.damage(PAGE);
    let mut bank_after = |address: u32| {
        bench.word_at(address);
        let eccr = bench.read("ECCR");
        bench.device.registers.field("ECCR", "BK_ECC").extract(eccr)
    };
    assert_eq!([START, PAGE].map(&mut bank_after), [0, 0]);
    assert!(bench.device.nmi());
    let eccr = bench.read("ECCR");
    bench.write("ECCR", eccr);
    bench.word_at(PAGE);
    let eccr = bench.read("ECCR");
    let bank = bench.device.registers.field("ECCR", "BK_ECC").extract(eccr);
    assert_eq!(bank, 1);
}
