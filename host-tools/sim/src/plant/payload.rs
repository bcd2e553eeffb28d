//! The payload at the tip.

/// Greatest payload, kg: that of the model.
const PAYLOAD_MAX_KG: f64 = 1e6;

/// A payload that changes linearly to its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Payload {
    pub now_kg: f64,
    target_kg: f64,
    /// Time until then, s.
    left_s: f64,
}

impl Payload {
    pub fn new(payload_kg: f64) -> Self {
        Self {
            now_kg: payload_kg,
            target_kg: payload_kg,
            left_s: 0.0,
        }
    }

    /// Sets a target, at least zero, and when it is reached. One that is not a number changes nothing.
    pub fn set(&mut self, target_kg: f64, over_s: f64) {
        if !target_kg.is_nan() {
            self.target_kg = target_kg.clamp(0.0, PAYLOAD_MAX_KG);
            self.left_s = over_s;
        }
    }

    pub fn advance(&mut self, span_s: f64) {
        let left = self.target_kg - self.now_kg;
        if self.left_s > span_s {
            self.now_kg += left * (span_s / self.left_s);
            self.left_s -= span_s;
        } else {
            self.now_kg = self.target_kg;
        }
    }
}
