"""The lowest bending stiffness over the workspace at three pretensions, by the model."""
import matplotlib.pyplot as plt
import numpy as np
from tendon_leg import Rig

rig = Rig("table1")
azimuth_deg, tilt_deg = np.linspace(0, 360, 181), np.linspace(0, 30, 61)
pretensions_n = [30, 70, 110]
maps = [
    rig.evaluate(azimuth_deg, tilt_deg[:, None], payload_kg=2.0, level_n=n, outputs=["bending_stiffness_nm_per_rad"])
    for n in pretensions_n
]
softest = [one["bending_stiffness_nm_per_rad"].min(axis=-1) for one in maps]
levels = np.arange(5 * (np.min(softest) // 5), np.max(softest) + 5, 5)

figure, axes = plt.subplots(1, 3, figsize=(12, 4.4), layout="constrained", subplot_kw={"projection": "polar"})
for axis, newtons, stiffness in zip(axes, pretensions_n, softest, strict=True):
    drawn = axis.contourf(np.radians(azimuth_deg), tilt_deg, stiffness, levels)
    axis.set(title=f"pretension {newtons} N", yticks=[10, 20, 30])
figure.colorbar(drawn, ax=axes, label="bending stiffness of the softest tilt, N·m/rad")
figure.suptitle("Paper's rig with 2 kg: azimuth, and tilt in degrees")
figure.savefig("stiffness_map.png", dpi=120)
