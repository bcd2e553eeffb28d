//! Whether the stack comes near the variables: the kibibyte just above them, which nothing but the stack can reach, has to
//! stay as it was.

use stm32g474_emulator::image::Image;
use stm32g474_emulator::processor::Processor;

/// Words that are watched.
const WORDS: u32 = 256;

/// The end of the variables, by cortex-m-rt's name.
const END: &str = "__sheap";

/// The words above the variables.
#[derive(Clone, Debug, Default)]
pub struct StackGuard {
    start: u32,
    words: Vec<Option<u32>>,
}

impl StackGuard {
    /// As they are now.
    pub fn new(image: &Image, processor: &Processor) -> Self {
        let start = image.symbol(END).unwrap_or_default();
        Self {
            start,
            words: words(start, processor),
        }
    }

    /// Whether they have changed, or the stack is below them: a large frame may leave them alone.
    pub fn is_reached(&self, processor: &Processor, stack_pointer: u32) -> bool {
        let end = self.start + 4 * WORDS;
        stack_pointer < end || words(self.start, processor) != self.words
    }
}

fn words(start: u32, processor: &Processor) -> Vec<Option<u32>> {
    let all = (0..WORDS).map(|word| processor.word(start + 4 * word));
    all.collect()
}
