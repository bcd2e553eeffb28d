"""The paper's Fig. 9: how far the tip sags over the tilt, by the model, as published, and of the simulated leg."""
import matplotlib.pyplot as plt
import numpy as np
from tendon_leg import Rig, SimulatedLeg

rig, tilt_deg = Rig("table1"), np.linspace(-30, 30, 61)
figure, axis = plt.subplots(figsize=(9, 5), layout="constrained")
for kg, published_mm in {0.0: 2.0, 0.5: 3.6, 1.0: 5.3, 2.0: 8.5}.items():  # what the paper's text gives
    model = rig.evaluate(30, tilt_deg, kg, stiffness_n_per_m=9.945e4, outputs=["deviation_m"])  # as the paper: constant
    [line] = axis.plot(tilt_deg, 1000 * model["deviation_m"], label=f"{kg} kg")
    axis.plot([-30, 30], [published_mm, published_mm], "x", color=line.get_color())
    for pose_deg in [-30, -20, -10, 0, 10, 20, 30]:
        leg = SimulatedLeg(rig, azimuth_deg=30 if pose_deg > 0 else 210, tilt_deg=abs(pose_deg), payload_kg=kg)
        leg.arm()
        leg.compensation("off")
        leg.run(2.5)
        axis.plot(pose_deg, leg.truth()["tip_error_mm"], "o", color=line.get_color(), fillstyle="none")
axis.set(title="Fig. 9: model (lines), published (x), simulated leg (o)", xlabel="tilt, °", ylabel="sag of the tip, mm")
axis.legend(title="payload", loc="upper center")
figure.savefig("fig9.png", dpi=120)
