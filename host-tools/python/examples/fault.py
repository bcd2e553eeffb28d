"""A tendon's load cell loses its wire while the leg moves: what the firmware says, and what the leg does."""
import matplotlib.pyplot as plt
from tendon_leg import LegFault, SimulatedLeg

leg = SimulatedLeg("table1", payload_kg=1.0)
leg.arm()
leg.record(["tilt_true_deg", "tensions_true_n", "tensions_n"], every_ticks=8)
leg.move(azimuth_deg=30, tilt_deg=25, wait=False)
leg.run(0.4)
begun_s = leg.time_s
leg.fault("cell_excitation_lost", tendon=2)
try:
    leg.move(azimuth_deg=30, tilt_deg=25)
except LegFault as fault:
    told = f"fault {fault.code}, {fault.name}: the leg is {fault.state}"
    print(f"{told}\n{fault.cause}; {fault.remedy}")
leg.run(0.5)
seen = leg.recording()
time_s = seen["time_s"] - begun_s

figure, (tilt, tension) = plt.subplots(2, 1, sharex=True, figsize=(7, 5), layout="constrained")
tilt.plot(time_s, seen["tilt_true_deg"])
tilt.set(title=f"Cell 2 loses its wire at 0 s: {told}", ylabel="true tilt, °")
tension.plot(time_s, seen["tensions_true_n"], label=["true, tendon 1", "true, tendon 2", "true, tendon 3"])
tension.plot(time_s, seen["tensions_n"][:, 1], "k:", label="measured, tendon 2")
tension.set(xlabel="time, s", ylabel="tension, N")
tension.legend()
figure.savefig("fault.png", dpi=120)
