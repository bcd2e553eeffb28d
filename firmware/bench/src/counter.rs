//! Counting the instructions of a kernel.

/// Something that can count the instructions that a kernel takes.
pub trait InstructionCounter {
    /// Instructions of one call of `kernel`, without the call and the return: a kernel with an empty body takes none.
    ///
    /// `None` where there is nothing to count with.
    fn count<A, B>(&mut self, kernel: fn(&A, &mut B), input: &A, output: &mut B) -> Option<u32>;
}
