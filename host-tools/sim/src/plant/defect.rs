//! Defects of the simulated leg: what can fail.

use serde::{Deserialize, Serialize};
use strum::{IntoStaticStr, VariantNames};

macro_rules! defects {
    (
        of_three { $($kind:ident $kind_text:literal;)* }
        of_the_leg { $($leg:ident $leg_text:literal;)* }
    ) => {
        /// One defect. A tendon, cell, encoder or motor is counted from 0 here, and from 1 in files.
        #[derive(
            Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, VariantNames, IntoStaticStr,
        )]
        #[serde(rename_all = "snake_case")]
        #[strum(serialize_all = "snake_case")]
        pub enum Defect {
            $(#[doc = $kind_text] $kind(#[serde(with = "from_one")] usize),)*
            $(#[doc = $leg_text] $leg,)*
        }

        /// Kinds of defects that each of the three tendons can have.
        const KINDS: &[fn(usize) -> Defect] = &[$(Defect::$kind),*];

        const OF_THE_LEG: &[Defect] = &[$(Defect::$leg),*];

        /// What each does, in the order of their names.
        const TEXTS: &[&str] = &[$($kind_text,)* $($leg_text,)*];
    };
}

defects! {
    of_three {
        TendonCut "A tendon does not pull. When the defect ends, a new one is on, without tension where the leg is: it has to home.";
        TendonSlips "A tendon slips by 5 mm at its clamp, once; it stays so when the defect ends.";
        TendonCreeps "A tendon grows longer by 0.1 mm in a second, and stays so when the defect ends.";
        CellStuck "A load cell repeats its last code and marks it as fresh.";
        CellSaturated "A load cell gives its highest code.";
        CellDead "A load cell gives its lowest code.";
        CellStale "A load cell converts no more: its last code stays, and is not fresh.";
        CellDrifting "A load cell's offset grows by 5 N in a second, and stays when the defect ends.";
        CellExcitationLost "A load cell's bridge has no supply: the amplifier's offset and noise are left.";
        CellFades "A load cell's gain falls to nothing within 0.5 s.";
        CellWanders "A load cell's signal wire is torn: what it showed last wanders within the range, 20 N in a second, 40 N in four.";
        CellHum "A load cell shows the middle of its range with 10 N of 50 Hz hum.";
        CellFollows "A load cell's input shows the next cell: 1 shows 2, 2 shows 3, 3 shows 1.";
        CellGainStep "A load cell shows 20 % more than the tension.";
        CellGainStepDown "A load cell shows 20 % less than the tension.";
        CellGainDrift "A load cell comes to show 20 % more within 10 s.";
        CellGainDriftDown "A load cell comes to show 20 % less within 10 s.";
        CellOffsetStep "A load cell shows 10 N more.";
        CellOffsetStepDown "A load cell shows 10 N less.";
        CellReversed "A load cell's signal wires are swapped: more tension shows as less.";
        CellCrosstalk "A load cell shows 15 % of the next cell's tension besides.";
        CellSticks "A load cell sticks: it follows the tension at a distance of 5 N.";
        CellLate "A load cell shows the tension of 20 ms ago.";
        CellPwmNoise "A load cell's wire lies beside its motor's: noise of 20 N times the duty, and as much offset.";
        EncoderLost "An encoder's counter stands still.";
        EncoderSlipping "An encoder loses every tenth count.";
        EncoderReversed "An encoder counts in the wrong direction.";
        EncoderJumps "An encoder counts bursts of 50 that are none, up or down, 20 in a second.";
        EncoderSlipsQuarter "An encoder slips by a quarter of a turn on its shaft, once; it stays so when the defect ends.";
        MotorJammed "A motor does not turn.";
        MotorIntermittent "A motor's plug makes contact for about half of the time, 10 ms at a time.";
        ScrewDry "A screw runs dry: it takes 0.05 N·m more at the motor.";
        GearPlay "A gear is worn: its play is 1 rad of the screw.";
        HalfBridgeOpen "A half bridge is open: nothing drives its motor inwards.";
        HalfBridgeOpenOutwards "A half bridge is open: nothing drives its motor outwards.";
        DriverFullOn "A driver's pulse line is torn: it drives its motor inwards with the whole supply while it is enabled.";
        DirectionStuck "A driver's direction line is torn: its motor is driven inwards whatever is asked.";
        CurrentOffset "A motor's current reads 10 A too high.";
        CurrentFullScale "A motor's current reads full scale.";
        CurrentFullScaleDisabled "A motor's current reads full scale while its driver is off.";
        CurrentDead "A motor's current reads its lowest code.";
        CurrentZero "A motor's current reads none.";
        DriverFault "A driver reports a fault and switches its motor off.";
    }
    of_the_leg {
        CellsSwapped "The plugs of load cells 1 and 2 are swapped.";
        EncodersSwapped "The plugs of encoders 1 and 2 are swapped.";
        ExcitationLost "No load cell's bridge has a supply.";
        ExcitationSags "The supply of all bridges sags: every load cell shows 20 % less than the tension.";
        LegGrasped "A hand holds the tip where it is, with 5 N for each millimetre.";
        SupplySag "The supply falls to 11 V.";
        SupplyDip "The supply falls to 12 V for 5 ms, once.";
        SupplySurge "The supply rises to 32 V.";
        Overheating "The drivers heat up by 20 K in a second.";
        LateTicks "Every tick ends too late.";
        SettingsCorrupt "The board's stored settings fail their check.";
    }
}

impl Defect {
    /// Every defect.
    pub fn all() -> impl Iterator<Item = Self> {
        let of_three = KINDS.iter().flat_map(|kind| (0..3).map(kind));
        of_three.chain(OF_THE_LEG.iter().copied())
    }

    /// How many kinds there are.
    pub const KINDS: usize = KINDS.len() + OF_THE_LEG.len();

    /// One of a kind, in the order of [`Self::descriptions`]; of a tendon, where each of the three can have it. None
    /// beyond the last.
    #[must_use]
    pub fn numbered(kind: usize, tendon: usize) -> Option<Self> {
        match KINDS.get(kind) {
            Some(of_three) => Some(of_three(tendon)),
            None => OF_THE_LEG.get(kind - KINDS.len()).copied(),
        }
    }

    /// Each name in files, and what it does, as a sentence.
    pub fn descriptions() -> impl Iterator<Item = (&'static str, &'static str)> {
        let names = Self::VARIANTS.iter().copied();
        names.zip(TEXTS.iter().copied())
    }
}

/// The defects at a time, each with the tick in which it began.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Defects(Vec<(Defect, u64)>);

impl Defects {
    /// Lets one begin at a tick, unless it has begun already, or end. Whether that changes anything.
    pub fn set(&mut self, defect: Defect, on: bool, tick: u64) -> bool {
        if self.has(defect) == on {
            return false;
        }
        if on {
            self.0.push((defect, tick));
        } else {
            self.0.retain(|(other, _)| *other != defect);
        }
        true
    }

    pub fn has(&self, defect: Defect) -> bool {
        self.first_tick(defect).is_some()
    }

    /// Each that has begun and not ended.
    pub fn all(&self) -> impl Iterator<Item = Defect> + '_ {
        self.0.iter().map(|(defect, _)| *defect)
    }

    /// The tick in which one began.
    pub fn first_tick(&self, defect: Defect) -> Option<u64> {
        let mut found = self.0.iter().filter(|(other, _)| *other == defect);
        found.next().map(|(_, tick)| *tick)
    }

    /// Which of the three have a kind of defect.
    pub fn affected(&self, kind: fn(usize) -> Defect) -> [bool; 3] {
        std::array::from_fn(|i| self.has(kind(i)))
    }
}

/// A number from 1 to 3 in a file, from 0 to 2 here.
pub(crate) mod from_one {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    #[allow(clippy::trivially_copy_pass_by_ref, reason = "serde asks for it")]
    pub fn serialize<S: Serializer>(index: &usize, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u64(*index as u64 + 1)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<usize, D::Error> {
        match usize::deserialize(deserializer)? {
            number @ 1..=3 => Ok(number - 1),
            number => Err(D::Error::custom(format!("{number} is none of 1, 2 and 3"))),
        }
    }
}
