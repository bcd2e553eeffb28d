"""A rig of one's own: the paper's with measured values of another leg. What the model says of it, and how it moves."""
import matplotlib.pyplot as plt
import numpy as np
from tendon_leg import Rig, SimulatedLeg

values = Rig("table1").to_dict()
values["mass"]["leg_kg"] = 1.6  # from a balance
values["tendon"] = {"f_min_n": 8, "f_max_n": 120, "pretension_n": 50, "stiffness_n_per_m": 6.0e4}  # from a tensile test
rig = Rig.from_dict(values, name="mine")
tilt_deg = np.linspace(0, 30, 61)
sag_mm = {one.name: 1000 * one.evaluate(30, tilt_deg, payload_kg=1.0, outputs=["deviation_m"])["deviation_m"] for one in [Rig("table1"), rig]}

leg = SimulatedLeg(rig)
leg.arm()
leg.record(["tilt_true_deg", "tilt_reference_deg"])
leg.move(azimuth_deg=30, tilt_deg=25)
seen = leg.recording()

figure, (sag, move) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
for name, curve in sag_mm.items():
    sag.plot(tilt_deg, curve, label=name)
sag.set(title="Sag of the tip under 1 kg, not compensated", xlabel="tilt, °", ylabel="mm", ylim=(0, None))
sag.legend()
move.plot(seen["time_s"], seen["tilt_true_deg"], linewidth=3, label="true")
move.plot(seen["time_s"], seen["tilt_reference_deg"], "k--", linewidth=1, label="reference")
move.set(title="A move of the leg of that rig", xlabel="time, s", ylabel="tilt, °")
move.legend()
figure.savefig("own_rig.png", dpi=120)
