//! The jogs of one motor: without a tension and against one, both ways, at several voltages.

use super::error::{LegError, TuneError};
use super::tuned_leg::TunedLeg;
use leg_base::jog_report::{Finding, findings};
use leg_firmware::board::timing::PWM_TOP;
use leg_firmware::control::SHOWN_PART;
use leg_firmware::jog::{JOG_TRAVEL_MAX_M, JogDemand, JogEnd, JogReport};
use leg_firmware::settings::{CurrentOutput, Servo, Settings};
use leg_firmware::telemetry::Telemetry;

/// How far a tendon is reeled in at the most until it pulls, beyond where the measurement began, m.
const REEL_MAX_M: f32 = 0.012;

/// Travel between two readings of the tension, m.
const STEP_M: f32 = 1e-3;

/// How often a step is paid out at the most until the tendon is slack.
const PAY_OUT_STEPS: u32 = 10;

/// A tendon whose tension changes by less over a step is slack, N: the softest leg changes by some newtons.
const SLACK_CHANGE_N: f32 = 0.5;

/// Part of the highest tension of a jog from which on the loaded jogs begin: half of it is left to them.
const LOADED_PART: f32 = 0.4;

/// Slowest jog, m/s: a screw sticks and slips where it is slower.
const SLOWEST_M_PER_S: f32 = 8e-4;

/// Fastest jog of a tendon that pulls, m/s: it goes through its tensions in a second.
const LOADED_M_PER_S: f32 = 2.5e-3;

/// Part of the highest voltage of a jog that is used: the rest is for a resistance that is greater than configured.
const VOLTAGE_PART: f32 = 0.9;

/// Part of the shortest pulse that a current output shows by which the lowest voltage is above it, where it does not show shorter ones.
const SHOWN_MARGIN: f32 = 0.05;

/// Voltages without a tension.
const FREE_VOLTAGES: u16 = 5;

/// Time for which a jog turns on when it is up to speed, s: current and speed are means over that time.
const STEADY_S: f32 = 0.4;

/// Time before that in which it goes half of its speed, on the mean, s: the rise of the voltage, and a half more.
const RISE_S: f32 = 0.1;

/// Travels of the jogs, m: a shorter one does not come up to speed.
const TRAVEL_MIN_M: f32 = 4e-4;
const TRAVEL_MAX_M: f32 = 4e-3;

/// Travel of a jog against a tension, m.
const LOADED_TRAVEL_M: f32 = 2e-3;

/// How often the jogs against a tension are repeated.
const LOADED_TIMES: u32 = 2;

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

/// The voltages and travels of the jogs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JogPlan {
    /// The motor, from 1.
    pub motor: u8,
    /// Lowest and highest voltage, V.
    pub voltages_v: [f32; 2],
    /// Voltage against a tension, V.
    pub loaded_v: f32,
    /// Farthest that one jog turns, m.
    pub travel_m: f32,
    /// Highest tension, N.
    pub tension_max_n: f32,
    back_emf_v_s_per_m: f32,
    /// What a step of the timer changes, V.
    step_v: f32,
}

impl JogPlan {
    /// For a motor, from 1, with the settings of its board and its supply, V. A board gives its motors whole steps of its timer, so
    /// every voltage is one of those: else the motor would not get what it is taken to get.
    #[must_use]
    pub fn new(motor: u8, settings: &Settings, supply_v: f32) -> Self {
        let own = usize::from(motor).saturating_sub(1);
        let servo = settings.servos.get(own).unwrap_or(&Servo::DEFAULT);
        let friction_v = servo.resistance_ohm * servo.friction_a;
        let at = |speed: f32| friction_v + servo.back_emf_v_s_per_m * speed;
        let bound_v = settings.limits.driven_part * servo.current_a * servo.resistance_ohm;
        let highest_v = (VOLTAGE_PART * bound_v).min(at(TRAVEL_MAX_M / (STEADY_S + RISE_S)));
        let shown_v = match settings.current_outputs.each().get(own) {
            Some(CurrentOutput::MagnitudeWhenDriven) => {
                (1.0 + SHOWN_MARGIN) * SHOWN_PART * supply_v
            }
            _ => 0.0,
        };
        let mut plan = Self {
            motor,
            voltages_v: [
                at(SLOWEST_M_PER_S).min(0.5 * highest_v).max(shown_v),
                highest_v,
            ],
            loaded_v: at(LOADED_M_PER_S).max(shown_v).min(highest_v),
            step_v: supply_v / f32::from(PWM_TOP),
            travel_m: 0.0,
            tension_max_n: settings.homing.f_max_n,
            back_emf_v_s_per_m: servo.back_emf_v_s_per_m,
        };
        plan.voltages_v = plan
            .voltages_v
            .map(|voltage_v| plan.whole_steps_v(voltage_v));
        plan.loaded_v = plan.whole_steps_v(plan.loaded_v);
        plan.travel_m = plan.travel_m(highest_v);
        plan
    }

    /// How far a jog at a voltage turns until it has been steady for long enough, m.
    fn travel_m(&self, voltage_v: f32) -> f32 {
        // Without friction, so that it is long enough in any case.
        let speed = voltage_v / self.back_emf_v_s_per_m;
        (speed * (STEADY_S + RISE_S)).clamp(TRAVEL_MIN_M, TRAVEL_MAX_M)
    }

    fn free_v(&self) -> impl Iterator<Item = f32> {
        let [low, high] = self.voltages_v;
        let step = (high - low) / f32::from(FREE_VOLTAGES - 1);
        (0..FREE_VOLTAGES).map(move |i| self.whole_steps_v(low + step * f32::from(i)))
    }

    fn whole_steps_v(&self, voltage_v: f32) -> f32 {
        (voltage_v / self.step_v).round() * self.step_v
    }

    fn slow_v(&self) -> f32 {
        self.loaded_v
    }

    /// How far the tendon is paid out and reeled in at the most beside where it began, m.
    #[must_use]
    pub fn reach_m(&self) -> [f32; 2] {
        let out_m = PAY_OUT_STEPS as f32 * STEP_M + self.travel_m;
        [out_m, REEL_MAX_M + LOADED_TRAVEL_M]
    }
}

/// Jogs the motor of a disarmed leg, and leaves its tendon where it was; where that cannot be, the error says so.
pub(super) async fn jog_all<L: TunedLeg>(
    leg: &mut L,
    plan: &JogPlan,
    settings: &Settings,
    seen: &mut dyn FnMut(&Jogged),
) -> Result<Vec<Jogged>, TuneError<L::Error>> {
    let own = |telemetry: &Telemetry<f32>| own_of(plan.motor, &telemetry.pulled_m);
    let start = leg.telemetry().await?;
    require_loose(plan, &start.tensions_n)?;
    let start_m = own(&start);
    let mut jogs = Jogs {
        leg,
        plan,
        settings,
        pulled_m: 0.0,
        turned: false,
        all: Vec::new(),
        seen,
    };
    let Err(error) = jogs.run().await else {
        return Ok(jogs.all);
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

/// Refuses a leg whose other tendons pull: where one is paid out, they pull the leg to their side, and the more.
fn require_loose<E>(plan: &JogPlan, tensions_n: &[f32; 3]) -> Result<(), TuneError<E>> {
    let taut_n = LOADED_PART * plan.tension_max_n;
    let mut others = (1_u8..).zip(tensions_n);
    match others.find(|&(number, &tension_n)| number != plan.motor && tension_n > taut_n) {
        Some((number, tension_n)) => Err(TuneError::undetermined(
            format!("tendon {number} pulls by {tension_n:.0} N before a motor is jogged"),
            "let the leg relax: `leg hold`, then `leg disarm`; before it is homed, pay its tendons out with `leg jog`",
        )),
        None => Ok(()),
    }
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
    /// Whether the last jog turned the motor as it was driven.
    turned: bool,
    all: Vec<Jogged>,
    seen: &'a mut dyn FnMut(&Jogged),
}

impl<L: TunedLeg> Jogs<'_, L> {
    async fn run(&mut self) -> Result<(), TuneError<L::Error>> {
        self.slacken().await?;
        self.free().await?;
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

    /// Pays the tendon out until its tension stays, and then by the longest jog, so that none of the free ones makes it pull.
    async fn slacken(&mut self) -> Result<(), TuneError<L::Error>> {
        for _ in 0..PAY_OUT_STEPS {
            let report = self.jog(-STEP_M, self.plan.slow_v()).await?;
            if self.change_n(&report).abs() < SLACK_CHANGE_N {
                self.jog(-self.plan.travel_m, self.plan.slow_v()).await?;
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
                let report = self.jog(travel_m, voltage_v).await?;
                if report.end != JogEnd::Arrived {
                    return Err(self.not_slack());
                }
                self.keep(&report, false);
            }
        }
        Ok(())
    }

    async fn loaded(&mut self) -> Result<(), TuneError<L::Error>> {
        self.reel_in().await?;
        for _ in 0..LOADED_TIMES {
            for voltage_v in [self.plan.loaded_v, self.plan.voltages_v[0]] {
                for travel_m in [LOADED_TRAVEL_M, -LOADED_TRAVEL_M] {
                    let report = self.jog(travel_m, voltage_v).await?;
                    self.keep(&report, true);
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
            let report = self.jog(STEP_M, self.plan.slow_v()).await?;
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

    /// Turns back to where it began.
    async fn put_back(&mut self) -> Result<(), TuneError<L::Error>> {
        while self.pulled_m.abs() > TRAVEL_MIN_M {
            let travel_m = (-self.pulled_m).clamp(-JOG_TRAVEL_MAX_M, JOG_TRAVEL_MAX_M);
            let report = self.jog(travel_m, self.plan.slow_v()).await?;
            if report.end != JogEnd::Arrived {
                break;
            }
        }
        Ok(())
    }

    async fn jog(
        &mut self,
        travel_m: f32,
        voltage_v: f32,
    ) -> Result<JogReport<f32>, TuneError<L::Error>> {
        let demand = JogDemand {
            motor: self.plan.motor,
            travel_m,
            voltage_v,
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
        self.pulled_m += self.own(&report.pulled_m);
        self.turned = matches!(report.end, JogEnd::Arrived | JogEnd::Tension(_));
        // To come to pull is what some of them are for.
        let pulls = report.end == JogEnd::Tension(self.plan.motor) && travel_m > 0.0;
        match findings(&report, self.settings).into_iter().next() {
            Some(finding) if !pulls => Err(TuneError::Finding(self.placed(finding, &demand))),
            _ => Ok(report),
        }
    }

    /// A finding with the jog in which it came.
    fn placed(&self, finding: Finding, demand: &JogDemand) -> Finding {
        let way = if demand.travel_m < 0.0 { "out" } else { "in" };
        Finding {
            what: format!("{}, at {:.2} V {way}", finding.what, demand.voltage_v),
            ..finding
        }
    }

    fn keep(&mut self, report: &JogReport<f32>, loaded: bool) {
        if report.steady_s < STEADY_MIN_S {
            return;
        }
        let jogged = Jogged {
            voltage_v: f64::from(report.demand.voltage_v.copysign(report.demand.travel_m)),
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
