//! What the window shows, as data: for tests, and for those who hear the page.

use crate::charts::ChartsState;
use crate::live_leg::LiveLeg;
use crate::pace::Pace;
use crate::places::Places;
use crate::player::PlayerState;
use crate::recorder::Recorder;
use crate::setup::state::SetupState;
use crate::shown_leg::ShownLeg;
use crate::top_bar::NOT_KNOWN;
use crate::work::WorkSummary;
use leg_base::angles;
use leg_base::description;
use serde::Serialize;
use std::collections::BTreeMap;

/// The window at a time.
#[derive(Debug, Serialize)]
pub struct PageState {
    /// The leg; none if there is none.
    leg: Option<LegState>,
    /// Why there is none.
    empty: Option<String>,
    /// Left, top, right and bottom of each control, points.
    places: BTreeMap<String, [f32; 4]>,
    /// The control that has the keyboard's focus.
    focused: Option<String>,
    /// Pixels of the page in a point.
    zoom: f32,
    /// Frames since the start.
    frames: u64,
    /// Time that the processor took for the last one, ms.
    frame_ms: Option<f32>,
    /// What the window itself took for each of the last ones, without what draws.
    work: Option<WorkSummary>,
    /// Rig files and settings.
    setup: SetupState,
    /// Signals over time, of the leg or of the recording.
    charts: ChartsState,
    /// A recording that is shown in the place of the leg.
    player: Option<PlayerState>,
    /// What a reader of the screen says.
    spoken: String,
}

/// How the window is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Drawing {
    /// Pixels of the page in a point.
    pub zoom: f32,
    /// Frames since the start.
    pub frames: u64,
    /// Time that the processor took for the last one, s.
    pub frame_s: Option<f32>,
    /// What the window itself took for each of the last ones.
    pub work: Option<WorkSummary>,
}

#[derive(Debug, Serialize)]
struct LegState {
    /// The name of a live one.
    live: Option<String>,
    /// The file that describes it, and how long it is from joint to tip, mm.
    rig: String,
    tip_mm: f64,
    /// Whether this page drives it, and another one.
    drives: [bool; 2],
    /// Why it takes no command but a stop.
    locked: Option<&'static str>,
    time_s: f64,
    /// Time of a simulated leg in a second of the clock.
    rate: f64,
    /// Time of the leg that was left out, s.
    left_out_s: f64,
    state: &'static str,
    faults: Vec<&'static str>,
    /// Whether these are all that it has now.
    faults_known: bool,
    refusal: Option<String>,
    compensated: Option<bool>,
    payload_kg: f64,
    error_mm: f64,
    azimuth_deg: f64,
    tilt_deg: f64,
    /// The horizontal components of the target's direction.
    target: [f64; 2],
    tensions_n: [f64; 3],
    pretension_n: Option<f32>,
    stiffness_nm_per_rad: Option<f32>,
    /// Where a push that is going on is directed to, degrees.
    push_deg: Option<f64>,
    failure: Option<String>,
    /// Time that is recorded of it, s, if it is recorded.
    recorded_s: Option<f64>,
}

impl PageState {
    /// Of a window.
    #[must_use]
    pub fn new(
        leg: Result<&ShownLeg, String>,
        places: &Places,
        drawing: Drawing,
        setup: SetupState,
        charts: ChartsState,
        player: Option<PlayerState>,
    ) -> Self {
        let rects = places.rects.iter().map(|(name, rect)| {
            let edges = [rect.left(), rect.top(), rect.right(), rect.bottom()];
            (name.to_string(), edges)
        });
        let (leg, empty) = match leg {
            Ok(leg) => (Some(LegState::new(leg)), None),
            Err(words) => (None, Some(words)),
        };
        let mut spoken = leg.as_ref().map_or_else(
            || format!("There is no leg. {}", empty.as_deref().unwrap_or_default()),
            LegState::spoken,
        );
        if let Some(player) = &player {
            spoken = format!("{spoken} {}", player.spoken());
        }
        if let Some(notice) = &setup.notice {
            spoken = format!("{spoken} {notice}");
        }
        Self {
            leg,
            empty,
            places: rects.collect(),
            focused: places.focused.as_ref().map(ToString::to_string),
            zoom: drawing.zoom,
            frames: drawing.frames,
            frame_ms: drawing.frame_s.map(|time_s| 1000.0 * time_s),
            work: drawing.work,
            setup,
            charts,
            player,
            spoken,
        }
    }
}

impl LegState {
    fn new(leg: &ShownLeg) -> Self {
        let leg_axis = leg.leg_axis();
        let simulation = leg.simulated();
        let pace = simulation.map_or_else(Pace::default, |simulation| simulation.pace);
        let live = leg.live();
        let role = live.map(LiveLeg::role).unwrap_or_default();
        let [azimuth_deg, tilt_deg] = angles::angles_deg([leg_axis.x, leg_axis.y]);
        let faults = leg.known_faults().unwrap_or_default().faults();
        let telemetry = leg.telemetry();
        Self {
            live: live.map(|live| live.name().into()),
            rig: leg.source().name.clone(),
            tip_mm: 1000.0 * leg.tip_length_m(),
            drives: [role.drives, role.other_drives],
            locked: leg.locked(),
            time_s: leg.time_s(),
            rate: pace.rate,
            left_out_s: pace.left_out_s(),
            state: leg.known_state().map_or(NOT_KNOWN, description::state),
            faults: faults.map(|fault| fault.entry().name).collect(),
            faults_known: leg.is_heard(),
            refusal: leg.refusal().map(Into::into),
            compensated: leg.compensated(),
            payload_kg: leg.payload_kg(),
            error_mm: leg.error_mm(),
            azimuth_deg,
            tilt_deg,
            target: leg.target(),
            tensions_n: leg.tensions_n(),
            pretension_n: telemetry.map(|telemetry| telemetry.pretension_n),
            stiffness_nm_per_rad: telemetry.map(|telemetry| telemetry.stiffness_nm_per_rad),
            push_deg: leg.pushed().map(|push| push.azimuth_deg),
            failure: leg.failure(),
            recorded_s: leg.recorder().map(Recorder::time_s),
        }
    }

    fn spoken(&self) -> String {
        if let Some(failure) = &self.failure {
            return format!("The state of the leg is {}. {failure}", self.state);
        }
        let faults = if self.faults.is_empty() {
            "none".into()
        } else {
            self.faults.join(", ")
        };
        format!("The leg is {}. Faults: {faults}.", self.state)
    }
}
