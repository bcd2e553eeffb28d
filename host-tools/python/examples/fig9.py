"""The paper's Fig. 9: 2 kg hang on a leg that leans by 30°, without compensation and with it."""
import matplotlib.pyplot as plt
from tendon_leg import SimulatedLeg

leg = SimulatedLeg("table1", seed=9, azimuth_deg=30, tilt_deg=30)
leg.arm()
leg.record(["tip_error_mm", "tensions_true_n"])
begun_s = leg.time_s
leg.compensation("off")
leg.run(1.0)
leg.payload(2.0, over_s=0.5)
leg.run(2.5)
leg.compensation("estimated")
leg.run(3.0)
seen = leg.recording()
time_s = seen["time_s"] - begun_s

figure, (tip, tension) = plt.subplots(2, 1, sharex=True, figsize=(7, 5), layout="constrained")
tip.plot(time_s, seen["tip_error_mm"])
tip.set(title="Fig. 9: sag of the tip; 2 kg from 1 s on, compensated from 3.5 s on", ylabel="mm", ylim=(0, None))
tension.plot(time_s, seen["tensions_true_n"], label=["tendon 1", "tendon 2", "tendon 3"])
tension.set(xlabel="time, s", ylabel="true tension, N", ylim=(0, None))
tension.legend()
figure.savefig("fig9.png", dpi=120)
