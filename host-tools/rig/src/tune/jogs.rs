//! The jogs of one motor: without a tension and against one, both ways, at several voltages.

use super::error::{LegError, TuneError};
use super::jog_plan::{
    JogPlan, LOADED_PART, LOADED_TRAVEL_M, PAY_OUT_MAX_M, REEL_MAX_M, STEP_M, TRAVEL_MIN_M,
};
use super::servo::{MeasuredServo, ServoJogs, point};
use super::tuned_leg::TunedLeg;
use leg_base::jog_report::{Finding, end_finding, tension_finding};
use leg_firmware::jog::{JOG_TRAVEL_MAX_M, JogDemand, JogDrive, JogEnd, JogReport, ServoResponse};
use leg_firmware::settings::Settings;
use leg_firmware::telemetry::Telemetry;

/// A tendon whose tension changes by less over a step is slack, N: the softest leg changes by some newtons.
const SLACK_CHANGE_N: f32 = 0.5;

/// How far a motor that is off may creep between two jogs, m: a hundred counts and more on the ready rigs, and less than any jog turns one.
const REST_M: f32 = 1e-4;

/// How often the jogs against a tension are repeated.
const LOADED_TIMES: u32 = 2;

/// How often the servo is measured both ways.
const SERVO_TIMES: u32 = 2;

/// Time after which a jog has a result, s.
const STEADY_MIN_S: f32 = 0.1;

/// What a jog at a steady speed showed, pull as positive.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Jogged {
    /// The voltage at the motor, V.
    pub voltage_v: f64,
    /// Its current, A.
    pub current_a: f64,
    /// The speed of the tendon, m/s.
    pub speed_m_per_s: f64,
    /// The tension of the tendon, N.
    pub tension_n: f64,
    /// Whether the tendon pulled.
    pub loaded: bool,
}

/// Jogs the motor of a disarmed leg, and leaves its tendon where it was; where that cannot be, the error says so.
pub(super) async fn jog_all<L: TunedLeg>(
    leg: &mut L,
    plan: &JogPlan,
    settings: &Settings,
    seen: &mut dyn FnMut(&Jogged),
) -> Result<(Vec<Jogged>, Result<MeasuredServo, Finding>), TuneError<L::Error>> {
    let own = |telemetry: &Telemetry<f32>| own_of(plan.motor, &telemetry.pulled_m);
    let start = leg.telemetry().await?;
    plan.require_shown()?;
    plan.require_loose(&start.tensions_n)?;
    let start_m = own(&start);
    let mut jogs = Jogs {
        leg,
        plan,
        settings,
        pulled_m: 0.0,
        rest_m: start.pulled_m,
        turned: false,
        slack_n: [0.0; 3],
        all: Vec::new(),
        servo: ServoJogs::default(),
        servo_finding: None,
        seen,
    };
    let Err(error) = jogs.run().await else {
        let servo = match jogs.servo_finding {
            Some(finding) => Err(finding),
            None => Ok(MeasuredServo::new(jogs.servo, plan.servo.step_m)),
        };
        return Ok((jogs.all, servo));
    };
    jogs.ease().await;
    // A jog that was cut off has no result, so the travel is read from the leg.
    let now = match &error {
        TuneError::Leg(error) => leg.telemetry_after(Some(error)).await,
        _ => leg.telemetry_after(None).await,
    };
    let by_m = now.map_or(0.0, |telemetry| own(&telemetry) - start_m);
    if by_m.abs() <= TRAVEL_MIN_M {
        return Err(error);
    }
    Err(TuneError::Displaced {
        error: Box::new(error),
        motor: plan.motor,
        by_m,
    })
}

/// What is of a motor's, from 1, own axis.
fn own_of(motor: u8, of_three: &[f32; 3]) -> f32 {
    let own = usize::from(motor).saturating_sub(1);
    of_three.get(own).copied().unwrap_or_default()
}

/// The jogs that are under way.
struct Jogs<'a, L> {
    leg: &'a mut L,
    plan: &'a JogPlan,
    settings: &'a Settings,
    /// How far the tendon is pulled in since the beginning, m.
    pulled_m: f32,
    /// Where each motor rests after the last jog, m.
    rest_m: [f32; 3],
    /// Whether the last jog turned the motor as it was driven.
    turned: bool,
    /// The tensions with this tendon slack, N.
    slack_n: [f32; 3],
    all: Vec<Jogged>,
    servo: ServoJogs,
    /// What ended a jog by the servo.
    servo_finding: Option<Finding>,
    seen: &'a mut dyn FnMut(&Jogged),
}

impl<L: TunedLeg> Jogs<'_, L> {
    async fn run(&mut self) -> Result<(), TuneError<L::Error>> {
        self.slacken().await?;
        self.free().await?;
        match self.servo().await {
            // One that rings is no reason to know nothing of its motor, and the motor is off.
            Err(TuneError::Finding(_)) if self.servo_finding.is_some() => {}
            result => result?,
        }
        self.loaded().await?;
        self.put_back().await
    }

    /// Lets no tendon pull on after an error. A motor that did not do what it was asked, a fault, Ctrl-C and a stop leave it where
    /// it is, and nothing is pulled in by a load cell in doubt.
    async fn ease(&mut self) {
        if self.turned && self.pulled_m > 0.0 {
            // What comes of it shows where the tendon is then.
            let _ = self.put_back().await;
        }
    }

    /// Pays the tendon out until its tension stays, in a step and in the longest jog after it: one that holds up the leg alone, far
    /// aside, changes by less than a slack one's noise in a step. None of the free jogs makes it pull then.
    async fn slacken(&mut self) -> Result<(), TuneError<L::Error>> {
        while STEP_M - self.pulled_m <= PAY_OUT_MAX_M {
            let step = self.jog(-STEP_M, self.plan.slow()).await?;
            if self.change_n(&step).abs() >= SLACK_CHANGE_N {
                continue;
            }
            let longest = self.jog(-self.plan.travel_m, self.plan.slow()).await?;
            if self.change_n(&longest).abs() < SLACK_CHANGE_N {
                [_, self.slack_n] = longest.tensions_n;
                return Ok(());
            }
        }
        Err(self.not_slack())
    }

    fn not_slack(&self) -> TuneError<L::Error> {
        TuneError::undetermined(
            format!("tendon {} does not become slack", self.plan.motor),
            "disarm the leg, and see that nothing pulls at it; pay the tendon out with `leg jog` and a negative travel",
        )
    }

    async fn free(&mut self) -> Result<(), TuneError<L::Error>> {
        for voltage_v in self.plan.free_v().collect::<Vec<_>>() {
            let travel_m = self.plan.travel_m(voltage_v);
            for travel_m in [travel_m, -travel_m] {
                let drive = JogDrive::Voltage(voltage_v);
                let report = self.jog_free(travel_m, drive).await?;
                self.keep(&report, voltage_v, false);
            }
        }
        Ok(())
    }

    /// Steps and sweeps of the servo, without a tension.
    async fn servo(&mut self) -> Result<(), TuneError<L::Error>> {
        for _ in 0..SERVO_TIMES {
            for sign in [1.0, -1.0] {
                let drive = JogDrive::ServoStep;
                let report = self.jog_free(sign * self.plan.servo.step_m, drive).await?;
                let Some(ServoResponse::Step {
                    overshoot_m,
                    settled_s,
                }) = report.servo
                else {
                    return Err(self.no_servo());
                };
                let overshoot = f64::from(overshoot_m / self.plan.servo.step_m);
                self.servo.steps.push([overshoot, settled_s.into()]);
            }
            for sign in [1.0, -1.0] {
                self.sweep(sign).await?;
            }
        }
        Ok(())
    }

    /// A sweep whose jogs begin that way, every other one back.
    async fn sweep(&mut self, mut sign: f32) -> Result<(), TuneError<L::Error>> {
        let mut points = Vec::new();
        for (travel_m, drive) in self.plan.servo.sweep() {
            let report = self.jog_free(sign * travel_m, drive).await?;
            points.push(point(drive, report.servo).ok_or_else(|| self.no_servo())?);
            sign = -sign;
        }
        points.sort_by(|a, b| a.hz.total_cmp(&b.hz));
        self.servo.sweeps.push(points);
        Ok(())
    }

    fn no_servo(&self) -> TuneError<L::Error> {
        TuneError::undetermined(
            format!("motor {} does not answer its servo", self.plan.motor),
            "see that firmware and host are of one version, and that nothing touches the motor",
        )
    }

    /// A jog of a slack tendon, which has to arrive.
    async fn jog_free(
        &mut self,
        travel_m: f32,
        drive: JogDrive,
    ) -> Result<JogReport<f32>, TuneError<L::Error>> {
        let report = self.jog(travel_m, drive).await?;
        if report.end == JogEnd::Arrived {
            Ok(report)
        } else {
            Err(self.not_slack())
        }
    }

    async fn loaded(&mut self) -> Result<(), TuneError<L::Error>> {
        self.reel_in().await?;
        for _ in 0..LOADED_TIMES {
            for voltage_v in [self.plan.loaded_v, self.plan.voltages_v[0]] {
                for travel_m in [LOADED_TRAVEL_M, -LOADED_TRAVEL_M] {
                    let drive = JogDrive::Voltage(voltage_v);
                    let report = self.jog(travel_m, drive).await?;
                    self.keep(&report, voltage_v, true);
                }
            }
        }
        Ok(())
    }

    /// Reels in until the tendon pulls.
    async fn reel_in(&mut self) -> Result<(), TuneError<L::Error>> {
        let free = self.all.iter().map(|jogged| jogged.tension_n);
        let slack_n = free.sum::<f64>() / self.all.len().max(1) as f64;
        while self.pulled_m + STEP_M <= REEL_MAX_M {
            let report = self.jog(STEP_M, self.plan.slow()).await?;
            self.require_own_cell(&report)?;
            let pull_n = f64::from(self.own(&report.tensions_n[1])) - slack_n;
            if pull_n >= f64::from(LOADED_PART * self.plan.tension_max_n) {
                return Ok(());
            }
        }
        Err(TuneError::undetermined(
            format!(
                "tendon {} does not come to pull within {:.0} mm",
                self.plan.motor,
                1000.0 * REEL_MAX_M
            ),
            "reel the tendons in until they hardly sag, with `leg jog`, and see that each load cell is that of its tendon",
        ))
    }

    /// Refuses a load cell that shows another tendon's tension, or the negative one, by what has changed since the tendon was slack: a
    /// jog alone changes it by less than the swing of a leg does.
    fn require_own_cell(&self, report: &JogReport<f32>) -> Result<(), TuneError<L::Error>> {
        let [_, now_n] = report.tensions_n;
        let since_slack = JogReport {
            tensions_n: [self.slack_n, now_n],
            ..*report
        };
        match tension_finding(&since_slack) {
            Some(finding) => Err(TuneError::Finding(finding)),
            None => Ok(()),
        }
    }

    /// Turns back to where it began.
    async fn put_back(&mut self) -> Result<(), TuneError<L::Error>> {
        while self.pulled_m.abs() > TRAVEL_MIN_M {
            let travel_m = (-self.pulled_m).clamp(-JOG_TRAVEL_MAX_M, JOG_TRAVEL_MAX_M);
            let report = self.jog(travel_m, self.plan.slow()).await?;
            if report.end != JogEnd::Arrived {
                break;
            }
        }
        Ok(())
    }

    async fn jog(
        &mut self,
        travel_m: f32,
        drive: JogDrive,
    ) -> Result<JogReport<f32>, TuneError<L::Error>> {
        let demand = JogDemand {
            motor: self.plan.motor,
            travel_m,
            drive,
        };
        self.turned = false;
        let (report, telemetry) = self.leg.jog(&demand).await?;
        let asked = "jog a motor";
        if telemetry.faults.stopping().any() {
            return Err(L::Error::faulted(asked, &telemetry).into());
        }
        if report.end == JogEnd::CutOff {
            return Err(L::Error::stopped(asked, telemetry.state).into());
        }
        self.require_rest(&report, &telemetry)?;
        self.pulled_m += self.own(&report.pulled_m);
        self.turned = matches!(report.end, JogEnd::Arrived | JogEnd::Tension(_));
        // To come to pull is what some of them are for.
        let pulls = report.end == JogEnd::Tension(self.plan.motor) && travel_m > 0.0;
        match end_finding(&report, self.settings) {
            Some(finding) if !pulls => {
                let finding = self.placed(finding, &demand);
                let by_servo = !matches!(drive, JogDrive::Voltage(_));
                if by_servo && report.end == JogEnd::Current {
                    self.servo_finding = Some(finding.clone());
                }
                Err(TuneError::Finding(finding))
            }
            _ => Ok(report),
        }
    }

    /// Refuses a leg that another host has used since the last jog: between two of them it is disarmed, and follows nobody.
    fn require_rest(
        &mut self,
        report: &JogReport<f32>,
        telemetry: &Telemetry<f32>,
    ) -> Result<(), TuneError<L::Error>> {
        let before = std::mem::replace(&mut self.rest_m, telemetry.pulled_m);
        let ways = report.pulled_m.iter().zip(before);
        let crept = ways.zip(telemetry.pulled_m);
        let turned = |((way_m, before_m), now_m): ((&f32, f32), f32)| {
            (now_m - before_m - way_m).abs() > REST_M
        };
        match (1..).zip(crept).find(|(_, motor)| turned(*motor)) {
            None => Ok(()),
            Some((motor, _)) => Err(TuneError::undetermined(
                format!("motor {motor} was turned between two jogs"),
                "end the other program that uses the leg, and let nobody touch it; then measure again",
            )),
        }
    }

    /// A finding with the jog in which it came.
    fn placed(&self, finding: Finding, demand: &JogDemand) -> Finding {
        let way = if demand.travel_m < 0.0 { "out" } else { "in" };
        let by = match demand.drive {
            JogDrive::Voltage(voltage_v) => format!("at {voltage_v:.2} V"),
            JogDrive::ServoStep | JogDrive::ServoSine { .. } => "by the servo".into(),
        };
        Finding {
            what: format!("{}, {by} {way}", finding.what),
            ..finding
        }
    }

    fn keep(&mut self, report: &JogReport<f32>, voltage_v: f32, loaded: bool) {
        if report.steady_s < STEADY_MIN_S {
            return;
        }
        let jogged = Jogged {
            voltage_v: f64::from(voltage_v.copysign(report.demand.travel_m)),
            current_a: f64::from(report.current_a),
            speed_m_per_s: f64::from(report.speed_m_per_s),
            tension_n: f64::from(report.tension_n),
            loaded,
        };
        (self.seen)(&jogged);
        self.all.push(jogged);
    }

    /// The change of the tendon's tension in a jog, N.
    fn change_n(&self, report: &JogReport<f32>) -> f32 {
        let [before, after] = &report.tensions_n;
        self.own(after) - self.own(before)
    }

    /// What is of the motor's own axis.
    fn own(&self, of_three: &[f32; 3]) -> f32 {
        own_of(self.plan.motor, of_three)
    }
}
