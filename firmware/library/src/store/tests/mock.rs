//! A flash as the STM32G4's: words that are written once, zeros that may be written over anything, and no power.

use crate::store::{PAGE_SIZE, WORD_SIZE};
use embedded_storage_async::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};

const ERASED: u8 = 0xFF;

/// What becomes of the word or page in work when the power fails.
#[derive(Clone, Copy, Debug)]
pub enum Tear {
    /// Nothing has happened yet.
    Before,
    /// All has happened, but nobody was told.
    After,
    /// Each bit has changed with this chance, in sixteenths.
    Bits(u64),
    /// The first bytes have changed, by chance how many.
    Head,
    /// The last bytes have changed.
    Tail,
    /// A word has each bit with even chance; a page is anything.
    Noise,
}

pub const TEARS: [Tear; 8] = [
    Tear::Before,
    Tear::After,
    Tear::Bits(1),
    Tear::Bits(8),
    Tear::Bits(15),
    Tear::Head,
    Tear::Tail,
    Tear::Noise,
];

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FlashFailure {
    PowerCut,
    NotErased(u32),
    Misaligned,
    Outside,
}

impl NorFlashError for FlashFailure {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

#[derive(Clone)]
pub struct Mock {
    pub bytes: Vec<u8>,
    /// Words that were written since they were erased.
    written: Vec<bool>,
    /// Words written and pages erased so far.
    pub steps: usize,
    /// How often each page was erased.
    pub erases: Vec<usize>,
    /// Whether the power failed in an erase.
    pub is_page_torn: bool,
    /// The step that is torn, and how.
    cut: Option<(usize, Tear)>,
    is_off: bool,
    random: Random,
}

/// Numbers that look random and are the same every time: SplitMix64.
#[derive(Clone)]
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    pub fn number_below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    fn byte(&mut self) -> u8 {
        self.next() as u8
    }

    /// Each bit set with this chance, in sixteenths.
    fn bits(&mut self, chance: u64) -> u8 {
        (0..8).fold(0, |bits, _| bits << 1 | u8::from(self.next() % 16 < chance))
    }
}

impl Mock {
    pub fn new(pages: usize) -> Self {
        Self::holding(vec![ERASED; pages * PAGE_SIZE])
    }

    pub fn holding(bytes: Vec<u8>) -> Self {
        let written = bytes
            .chunks(WORD_SIZE)
            .map(|word| word.iter().any(|&byte| byte != ERASED));
        Self {
            written: written.collect(),
            steps: 0,
            erases: vec![0; bytes.len() / PAGE_SIZE],
            is_page_torn: false,
            cut: None,
            is_off: false,
            random: Random(0),
            bytes,
        }
    }

    pub fn range(&self) -> core::ops::Range<u32> {
        0..self.bytes.len() as u32
    }

    /// The power fails after so many more steps, within the next.
    pub fn cut_after(&mut self, steps: usize, tear: Tear, seed: u64) {
        self.cut = Some((self.steps + steps, tear));
        self.random = Random(seed);
    }

    pub fn restart(&mut self) {
        *self = Self {
            erases: self.erases.clone(),
            is_page_torn: self.is_page_torn,
            ..Self::holding(self.bytes.clone())
        };
    }

    pub fn flip(&mut self, bit: usize) {
        self.bytes[bit / 8] ^= 1 << (bit % 8);
    }

    /// Makes a word refuse writes though it reads as erased, until its page is erased.
    pub fn refuse(&mut self, address: usize) {
        self.written[address / WORD_SIZE] = true;
    }

    /// Counts a step; how it is torn, if it is.
    fn step(&mut self) -> Result<Option<Tear>, FlashFailure> {
        self.powered()?;
        let tear = self.cut.filter(|(step, _)| *step == self.steps);
        self.steps += 1;
        self.is_off = tear.is_some();
        Ok(tear.map(|(_, tear)| tear))
    }

    fn powered(&self) -> Result<(), FlashFailure> {
        match self.is_off {
            true => Err(FlashFailure::PowerCut),
            false => Ok(()),
        }
    }

    fn check(&self, offset: u32, length: usize, unit: usize) -> Result<usize, FlashFailure> {
        let offset = offset as usize;
        if !offset.is_multiple_of(unit) || !length.is_multiple_of(unit) {
            return Err(FlashFailure::Misaligned);
        }
        match offset + length <= self.bytes.len() {
            true => Ok(offset),
            false => Err(FlashFailure::Outside),
        }
    }

    /// Brings the bytes from `start` on towards others, as far as the tear lets it.
    fn change(&mut self, start: usize, towards: &[u8], tear: Option<Tear>) {
        let reached = self.random.number_below(towards.len() + 1);
        for (i, &byte) in towards.iter().enumerate() {
            let mask = match tear {
                None | Some(Tear::After) => 0xFF,
                Some(Tear::Before) => 0,
                Some(Tear::Bits(chance)) => self.random.bits(chance),
                Some(Tear::Head) => [0, 0xFF][usize::from(i < reached)],
                Some(Tear::Tail) => [0xFF, 0][usize::from(i < reached)],
                Some(Tear::Noise) => self.random.byte(),
            };
            let place = &mut self.bytes[start + i];
            *place = *place & !mask | byte & mask;
        }
    }

    fn write_word(&mut self, start: usize, word: &[u8]) -> Result<(), FlashFailure> {
        let tear = self.step()?;
        let is_zero = word.iter().all(|&byte| byte == 0);
        if self.written[start / WORD_SIZE] && !is_zero {
            return Err(FlashFailure::NotErased(start as u32));
        }
        self.change(start, word, tear);
        self.written[start / WORD_SIZE] = true;
        tear.map_or(Ok(()), |_| Err(FlashFailure::PowerCut))
    }

    fn erase_page(&mut self, start: usize) -> Result<(), FlashFailure> {
        let tear = self.step()?;
        self.erases[start / PAGE_SIZE] += 1;
        self.is_page_torn = tear.is_some();
        if matches!(tear, Some(Tear::Noise)) {
            self.bytes[start..][..PAGE_SIZE].fill_with(|| self.random.byte());
        } else {
            self.change(start, &[ERASED; PAGE_SIZE], tear);
        }
        self.written[start / WORD_SIZE..][..PAGE_SIZE / WORD_SIZE].fill(false);
        tear.map_or(Ok(()), |_| Err(FlashFailure::PowerCut))
    }
}

impl ErrorType for Mock {
    type Error = FlashFailure;
}

impl ReadNorFlash for Mock {
    const READ_SIZE: usize = 1;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), FlashFailure> {
        self.powered()?;
        let start = self.check(offset, bytes.len(), Self::READ_SIZE)?;
        bytes.copy_from_slice(&self.bytes[start..][..bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.bytes.len()
    }
}

impl NorFlash for Mock {
    const WRITE_SIZE: usize = WORD_SIZE;
    const ERASE_SIZE: usize = PAGE_SIZE;

    async fn erase(&mut self, from: u32, to: u32) -> Result<(), FlashFailure> {
        let length = (to - from) as usize;
        let start = self.check(from, length, Self::ERASE_SIZE)?;
        (start..start + length)
            .step_by(PAGE_SIZE)
            .try_for_each(|page| self.erase_page(page))
    }

    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), FlashFailure> {
        let start = self.check(offset, bytes.len(), Self::WRITE_SIZE)?;
        (start..)
            .step_by(WORD_SIZE)
            .zip(bytes.chunks(WORD_SIZE))
            .try_for_each(|(address, word)| self.write_word(address, word))
    }
}
