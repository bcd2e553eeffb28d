//! The settings in the flash.

use super::runs::{saving, saving_in_one_bank};
use super::{Mistake, mistakes};

const FLASH: &str = "firmware/stm32g474/src/flash.rs";
const REGION: &str = "firmware/library/src/store/region.rs";

/// The line of the settings' place.
const PLACE: &str = "= FLASH_SIZE - 0x4000..FLASH_SIZE;";

mistakes! {
    flash_not_unlocked: Mistake {
        file: FLASH,
        right: "        Self::require_two_banks()?;\n        self.0.write(",
        // A wrong key locks the flash until the next reset.
        wrong: "        Self::require_two_banks()?;
        pac::FLASH.keyr().write_value(0);
        self.0.write(",
        run: saving,
        report: "FLASH_KEYR",
    };
    settings_in_the_first_bank: Mistake {
        file: REGION,
        right: PLACE,
        wrong: "= BANK_2 - 0x4000..BANK_2;",
        run: saving,
        report: "stalls the program, which runs from the same bank",
    };
    settings_over_the_program: Mistake {
        file: REGION,
        right: PLACE,
        wrong: "= 0x8000..0xc000;",
        run: saving,
        report: "touches a page of the program",
    };
    option_byte_of_the_banks_ignored: Mistake {
        file: FLASH,
        right: "if pac::FLASH.optr().read().dbank() {",
        wrong: "if true {",
        run: saving_in_one_bank,
        report: "stalls the program, which runs from the same bank",
    };
}
