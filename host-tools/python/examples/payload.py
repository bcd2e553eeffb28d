"""A payload is hung on a leg that was not told of it: the payload estimated from the tensions, and how far the tip goes."""
import matplotlib.pyplot as plt
from tendon_leg import SimulatedLeg

leg = SimulatedLeg("table1", azimuth_deg=30, tilt_deg=20)
leg.arm()
leg.run(0.5)
leg.record(["payload_true_kg", "payload_kg", "tip_error_mm"])
for kg in [0.5, 1.5, 1.0, 0.0]:
    leg.payload(kg, over_s=0.3)
    leg.run(1.5)
seen = leg.recording()
time_s = seen["time_s"] - seen["time_s"][0]

figure, (payload, error) = plt.subplots(2, 1, sharex=True, figsize=(7, 5), layout="constrained")
payload.plot(time_s, seen["payload_true_kg"], "k--", linewidth=1, label="true")
payload.plot(time_s, seen["payload_kg"], label="estimated from the tensions")
payload.set(title="Payload at azimuth 30°, tilt 20°", ylabel="kg")
payload.legend()
error.plot(time_s, seen["tip_error_mm"])
error.set(title="Distance of the true tip from where it was sent", xlabel="time, s", ylabel="mm", ylim=(0, None))
figure.savefig("payload.png", dpi=120)
