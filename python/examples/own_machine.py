"""A mesh of your own on a machine of your own: how large need its first cache be? A sweep, with a plot and a table."""

# %% A mesh: vertices and faces, here a wavy sheet.
import matplotlib.pyplot as plt
import numpy as np

import lodray

side = 60
x, y = np.meshgrid(np.linspace(-1, 1, side), np.linspace(-1, 1, side))
vertices = np.column_stack([x.ravel(), 0.1 * np.sin(9 * x + 4 * y).ravel(), y.ravel()])
corner = np.arange(side * side).reshape(side, side)[:-1, :-1].ravel()
faces = np.concatenate(
    [np.column_stack([corner, corner + side, corner + 1]), np.column_stack([corner + 1, corner + side, corner + side + 1])]
)
scene = lodray.Scene.build(vertices, faces, max_error=0.5, levels=3, name="sheet", keep_mesh=True)
print(scene, f"{scene.info['bytes']} bytes")

# %% A machine, changed; each method needs its structures once.
machines = []
for kilobytes in (8, 16, 32, 64):
    machine = lodray.Machine("haydel2023")
    machine.l1.bytes = 1024 * kilobytes
    machines.append(machine)
camera = scene.camera(size=(240, 135), distance=2.0)
rows = []
for name in ("lod", "input-bvh"):
    # The rays are traced once for all machines.
    for result in scene.method(name).simulate(machines, camera):
        rows.append(lodray.flat(result))

# %% pandas.DataFrame(rows) and polars.DataFrame(rows) are tables of this.
for name in ("lod", "input-bvh"):
    own = [row for row in rows if row["setup.method.name"] == name]
    sizes = [row["setup.machine.description.l1.bytes"] / 1024 for row in own]
    plt.plot(sizes, [row["milliseconds"] for row in own], marker="o", label=name)
    for size, row in zip(sizes, own):
        print(f"{name:10} {size:3.0f} KB {row['milliseconds']:.4f} ms {row['energy.total']:10.1f} {row['energy.unit']}")
plt.xscale("log", base=2)
plt.xlabel("first cache, KB")
plt.ylabel("milliseconds a frame")
plt.legend()
plt.savefig("own_machine.svg")
