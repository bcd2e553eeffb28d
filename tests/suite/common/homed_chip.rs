//! A chip that homes once for many scenarios.
//!
//! Homing is half of what a scenario takes on a chip, and most scenarios begin with the same. What was asked of the first
//! chip up to the end of its homing is kept with its answers, and a copy of that chip; a scenario that asks the same gets
//! the same answers, and goes on with a copy of the copy. One that asks something else gets a chip of its own, which is asked
//! all of it.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_boards::chip::ChipSession;
use leg_firmware::supervisor::State;
use leg_firmware_bench::protocol::{Reply, Request, TickRequest};
use leg_sim::link::{Link, LinkError};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// The longest request or reply, packed.
const PACKED_MAX: usize = 8192;

/// What was asked and answered, packed.
struct Exchange {
    request: Vec<u8>,
    reply: Vec<u8>,
    /// What the leg took in that tick.
    taken: Vec<u8>,
}

/// A homing: the exchanges from the start to its end, and the chip then.
struct Homing {
    exchanges: Vec<Exchange>,
    homed: Mutex<ChipSession>,
}

/// The homings that were seen.
#[derive(Default)]
pub struct Homings(Mutex<Vec<Arc<Homing>>>);

impl Homings {
    /// A chip whose leg is active after its homing.
    pub fn active(&self) -> Option<ChipSession> {
        let known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let active = |homing: &&Arc<Homing>| {
            let ended = homing.exchanges.last();
            ended.is_some_and(|ended| state(&unpacked(&ended.reply)) == Some(State::Active))
        };
        let homed = known.iter().find(active)?.homed.lock();
        homed.unwrap_or_else(PoisonError::into_inner).copy().ok()
    }
}

/// Where a scenario's chip is.
enum Progress {
    /// It is asked what others were asked: by now so many exchanges.
    Repeats(Arc<Homing>, usize),
    /// A chip of its own that has not homed yet.
    Homes(ChipSession, Vec<Exchange>),
    /// A chip of its own.
    Own(ChipSession),
}

/// A chip for a scenario.
pub struct HomedChip<'a> {
    image: &'a Path,
    homings: &'a Homings,
    progress: Option<Progress>,
    taken: Option<TickRequest>,
    /// Ticks that were answered by another chip.
    pub repeated: usize,
}

impl<'a> HomedChip<'a> {
    /// A chip with an image, which goes on from one of the homings if its scenario begins alike.
    pub fn new(image: &'a Path, homings: &'a Homings) -> Self {
        Self {
            image,
            homings,
            progress: None,
            taken: None,
            repeated: 0,
        }
    }

    /// At the first request.
    fn begin(&self, request: &[u8]) -> Result<Progress, LinkError> {
        let known = self
            .homings
            .0
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let alike = |homing: &&Arc<Homing>| homing.exchanges[0].request == request;
        Ok(match known.iter().find(alike) {
            Some(homing) => Progress::Repeats(Arc::clone(homing), 0),
            None => Progress::Homes(ChipSession::open(self.image)?, Vec::new()),
        })
    }

    /// A chip of its own that has been asked what the homing's was.
    fn caught_up(&self, asked: &[Exchange]) -> Result<ChipSession, LinkError> {
        let mut chip = ChipSession::open(self.image)?;
        for exchange in asked {
            chip.ask(&unpacked(&exchange.request))?;
        }
        Ok(chip)
    }

    fn ask_own(&mut self, mut chip: ChipSession, request: &Request) -> Result<Reply, LinkError> {
        let reply = chip.ask(request);
        self.taken = chip.taken();
        self.progress = Some(Progress::Own(chip));
        reply
    }

    fn ask_homing(
        &mut self,
        mut chip: ChipSession,
        mut exchanges: Vec<Exchange>,
        request: &Request,
    ) -> Result<Reply, LinkError> {
        let reply = chip.ask(request)?;
        self.taken = chip.taken();
        let before = exchanges.last().map(|exchange| unpacked(&exchange.reply));
        let homed = before.as_ref().is_some_and(homes) && !homes(&reply);
        exchanges.push(Exchange {
            request: packed(request),
            reply: packed(&reply),
            taken: packed(&self.taken),
        });
        if homed {
            let homed = Mutex::new(chip.copy()?);
            let homing = Arc::new(Homing { exchanges, homed });
            let mut known = self
                .homings
                .0
                .lock()
                .unwrap_or_else(PoisonError::into_inner);
            known.push(homing);
            self.progress = Some(Progress::Own(chip));
        } else {
            self.progress = Some(Progress::Homes(chip, exchanges));
        }
        Ok(reply)
    }

    fn repeat(
        &mut self,
        homing: Arc<Homing>,
        index: usize,
        request: &Request,
    ) -> Result<Reply, LinkError> {
        let Some(exchange) = homing.exchanges.get(index) else {
            let homed = homing.homed.lock().unwrap_or_else(PoisonError::into_inner);
            return self.ask_own(homed.copy()?, request);
        };
        if exchange.request != packed(request) {
            let chip = self.caught_up(&homing.exchanges[..index])?;
            self.repeated = 0;
            return self.ask_own(chip, request);
        }
        self.repeated += usize::from(matches!(request, Request::Tick(_)));
        self.taken = unpacked(&exchange.taken);
        let reply = unpacked(&exchange.reply);
        self.progress = Some(Progress::Repeats(homing, index + 1));
        Ok(reply)
    }
}

impl Link for HomedChip<'_> {
    fn ask(&mut self, request: &Request) -> Result<Reply, LinkError> {
        let progress = match self.progress.take() {
            Some(progress) => progress,
            None => self.begin(&packed(request))?,
        };
        match progress {
            Progress::Repeats(homing, index) => self.repeat(homing, index, request),
            Progress::Homes(chip, exchanges) => self.ask_homing(chip, exchanges, request),
            Progress::Own(chip) => self.ask_own(chip, request),
        }
    }

    fn taken(&mut self) -> Option<TickRequest> {
        self.taken.clone()
    }
}

fn homes(reply: &Reply) -> bool {
    state(reply) == Some(State::Homing)
}

fn state(reply: &Reply) -> Option<State> {
    match reply {
        Reply::Ticked(tick) => Some(tick.telemetry.state),
        _ => None,
    }
}

fn packed(value: &impl serde::Serialize) -> Vec<u8> {
    let mut buffer = [0; PACKED_MAX];
    postcard::to_slice(value, &mut buffer).unwrap().to_vec()
}

fn unpacked<T: serde::de::DeserializeOwned>(bytes: &[u8]) -> T {
    postcard::from_bytes(bytes).unwrap()
}
