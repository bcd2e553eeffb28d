"""The simulated leg follows a circle with a payload that it was not told of: where its tip was sent, and where it is."""
import matplotlib.pyplot as plt
import numpy as np
from tendon_leg import SimulatedLeg

time_s = np.arange(0.0, 10.005, 0.01)  # 100 points a second, two turns at 0.2 Hz
leg = SimulatedLeg("table1", payload_kg=1.0)
leg.arm()
leg.record(["tip_commanded_mm", "tip_true_mm", "path_error_mm"])
leg.follow(np.column_stack([time_s, 72.0 * time_s, np.full_like(time_s, 20.0)]))
seen = leg.recording()
seen = {name: values[np.isfinite(seen["path_error_mm"])] for name, values in seen.items()}  # on the path alone

figure, (path, error) = plt.subplots(1, 2, figsize=(10, 4.2), layout="constrained")
sent, true = seen["tip_commanded_mm"][:, :2].T, seen["tip_true_mm"][:, :2].T
path.plot(*sent, "k--", linewidth=1, label="commanded")
path.plot(*(sent + 500 * (true - sent)), label="true, 500 times as far off")
path.set(title="Tip from above", xlabel="x, mm", ylabel="y, mm", aspect="equal")
path.legend(loc="center")
error.plot(seen["time_s"] - seen["time_s"][0], 1000 * seen["path_error_mm"])
worst_um = 1000 * seen["path_error_mm"].max()
error.set(title=f"Distance of the true tip from its path: {worst_um:.0f} µm at most", xlabel="time, s", ylabel="µm", ylim=(0, None))
figure.savefig("circle.png", dpi=120)
