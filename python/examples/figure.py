"""Figure 11 of the paper for one scene: the time of a frame against the distance, with level of detail and without. Ten lines."""

import matplotlib.pyplot as plt

import lodray

distances = [1.5, 2, 4, 8, 16, 32]
scene = lodray.Scene.generate("terrain", levels=5)
for method in ("lod", "bvh"):
    frames = [scene.simulate("haydel2023", scene.camera(size=(240, 135), distance=d), method=method) for d in distances]
    plt.loglog(distances, [frame["milliseconds"] for frame in frames], marker="o", label=method)
plt.xlabel("distance in bounding radii")
plt.ylabel("milliseconds a frame")
plt.legend()
plt.savefig("figure.svg")
