"""The peers of `cargo xtask bench`: gpflow and Embree, answering as `mapless-bench` does.

PyPI's lightgp 0.1.2 does other work and is left out: its sparse process knows the squared-exponential kernel alone, with one
length-scale, in single precision, and chooses the inducing inputs itself.

`peers.py FOLDER` reads the inputs that `mapless-bench FOLDER` wrote, then answers a line for each request until its input ends:
`NAME N` runs a piece of work N times, `{"ms": [...]}`; `NAME values` tells what it gives, `{"values": {...}}`; `versions all` tells the versions, `{"versions": {...}}`.
"""

import json
import os
import sys
import time
from pathlib import Path

# Before the libraries start: one thread each.
os.environ.update(
    TF_NUM_INTRAOP_THREADS="1",
    TF_NUM_INTEROP_THREADS="1",
    OMP_NUM_THREADS="1",
    TF_CPP_MIN_LOG_LEVEL="3",
    CUDA_VISIBLE_DEVICES="",
)

import embreex
import gpflow
import numpy as np
import tensorflow as tf
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene


def model_of(inputs, inducing):
    """gpflow's SGPR on the inputs, in its default double precision."""
    hyperparameters = inputs["hyperparameters"]
    kernel = gpflow.kernels.RationalQuadratic(
        variance=hyperparameters["kernel"]["variance"],
        lengthscales=hyperparameters["kernel"]["length_scales_rad"],
        alpha=hyperparameters["kernel"]["alpha"],
    )
    data = np.array(inputs["inputs"]), np.array(inputs["targets"])[:, None]
    return gpflow.models.SGPR(
        data, kernel, np.array(inducing), noise_variance=hyperparameters["noise_variance"]
    )


class Posterior:
    """Mean and variance on 360 x 30, from the data on."""

    def __init__(self, inputs, inducing):
        model, queries = model_of(inputs, inducing), tf.constant(inputs["queries"], tf.float64)
        self.compiled = tf.function(lambda: model.predict_f(queries))

    def run(self):
        self.mean, self.variance = (tensor.numpy()[:, 0] for tensor in self.compiled())

    def values(self):
        return {"mean": self.mean.tolist(), "variance": self.variance.tolist()}


class Bound:
    """The bound and its gradients for every parameter, as gpflow's own optimisers ask for them."""

    def __init__(self, inputs, inducing):
        model = model_of(inputs, inducing)
        kernel = model.kernel
        self.logarithmic = [kernel.variance, kernel.lengthscales, kernel.alpha, model.likelihood.variance]
        self.points = model.inducing_variable.Z
        variables = [parameter.unconstrained_variable for parameter in [*self.logarithmic, self.points]]

        def bound_and_gradients():
            with tf.GradientTape() as tape:
                bound = model.elbo()
            return bound, tape.gradient(bound, variables)

        self.compiled = tf.function(bound_and_gradients)

    def run(self):
        self.bound, gradients = self.compiled()
        self.gradients = [np.asarray(gradient) for gradient in gradients]

    def values(self):
        log_gradient = []
        for parameter, gradient in zip(self.logarithmic, self.gradients):
            # From gpflow's unconstrained variable u to log p: dF/du / (dp/du) p.
            unconstrained = parameter.unconstrained_variable
            slope = np.exp(parameter.transform.forward_log_det_jacobian(unconstrained, event_ndims=0))
            log_gradient.extend(np.ravel(gradient / slope * parameter.numpy()).tolist())
        return {
            "bound": [float(self.bound)],
            "log_gradient": log_gradient,
            "inducing_gradient": self.gradients[-1].ravel().tolist(),
        }


def cuboid(solid):
    """Vertices and faces of a turned box."""
    sin, cos = solid["sin_cos_yaw"]
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * solid["half_m"]
    turned = np.stack([corners[:, 0] * cos - corners[:, 1] * sin, corners[:, 0] * sin + corners[:, 1] * cos, corners[:, 2]], 1)
    faces = [[0, 1, 3], [0, 3, 2], [4, 7, 5], [4, 6, 7], [0, 5, 1], [0, 4, 5], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
    return turned, np.array(faces)


def rings(profile, around):
    """Vertices and faces about the z axis through a profile of (radius, z)."""
    turns = np.arange(around) * (2 * np.pi / around)
    vertices = np.concatenate([np.stack([r * np.cos(turns), r * np.sin(turns), np.full(around, z)], 1) for r, z in profile])
    index = np.arange(len(profile) * around).reshape(len(profile), around)
    below, above = index[:-1].ravel(), index[1:].ravel()
    beside_below, beside_above = np.roll(index, -1, 1)[:-1].ravel(), np.roll(index, -1, 1)[1:].ravel()
    faces = np.concatenate([np.stack([below, beside_below, beside_above], 1), np.stack([below, beside_above, above], 1)])
    return vertices, faces


def mesh_of(solid):
    """Vertices in the world and faces of a solid; round ones are within a millimetre."""
    if solid["shape"] == "cuboid":
        vertices, faces = cuboid(solid)
    elif solid["shape"] == "cylinder":
        radius_m, half_m = solid["radius_m"], solid["half_height_m"]
        vertices, faces = rings([(0, -half_m), (radius_m, -half_m), (radius_m, half_m), (0, half_m)], 64)
    else:
        polar = np.linspace(0, np.pi, 49)
        vertices, faces = rings([(solid["radius_m"] * np.sin(a), -solid["radius_m"] * np.cos(a)) for a in polar], 96)
    return vertices + solid["centre_m"], faces


class Scanning:
    """Embree's first hits on the field, each cell two triangles, and on what stands there."""

    def __init__(self, inputs, folder, name):
        samples, cell_m = inputs["samples"], inputs["cell_m"]
        heights = np.fromfile(folder / f"{name}.f32", "<f4").reshape(samples, samples)
        along = np.arange(samples) * cell_m
        x, y = np.meshgrid(along, along)
        vertices = np.stack([x.ravel(), y.ravel(), heights.ravel()], 1).astype(np.float32)
        index = np.arange(samples * samples).reshape(samples, samples)
        sw, se, nw, ne = (
            corner.ravel() for corner in (index[:-1, :-1], index[:-1, 1:], index[1:, :-1], index[1:, 1:])
        )
        faces = np.concatenate([np.stack([sw, se, nw], 1), np.stack([se, ne, nw], 1)]).astype(np.int32)
        self.scene = EmbreeScene()
        self.meshes = [TriangleMesh(self.scene, vertices, faces)]
        solids = [mesh_of(solid) for solid in inputs["solids"].get(name, [])]
        if solids:
            firsts = np.cumsum([0] + [len(vertices) for vertices, _ in solids])
            vertices = np.concatenate([vertices for vertices, _ in solids]).astype(np.float32)
            faces = np.concatenate([faces + first for (_, faces), first in zip(solids, firsts)]).astype(np.int32)
            self.meshes.append(TriangleMesh(self.scene, vertices, faces))
        self.directions = np.fromfile(folder / "directions.f32", "<f4").reshape(-1, 3)
        sensor = np.array([inputs["sensors_m"][name]], np.float32)
        self.origins = np.tile(sensor, (len(self.directions), 1))
        self.max_range_m = inputs["max_range_m"]

    def run(self):
        self.range_m = self.scene.run(self.origins, self.directions, query="DISTANCE")

    def values(self):
        return {"range_m": [float(r) if r <= self.max_range_m else None for r in self.range_m]}


def make(inputs, folder, name):
    """The piece of work called `name`."""
    kind, _, number = name.rpartition("-")
    if kind in ("posterior", "bound"):
        return {"posterior": Posterior, "bound": Bound}[kind](inputs, inputs["inducing"][number])
    return Scanning(inputs, folder, name)


def answer(inputs, folder, works, request):
    """The answer to one request."""
    name, what = request.split()
    if name == "versions":
        return {"versions": {"gpflow": gpflow.__version__, "tensorflow": tf.__version__, "embreex": embreex.__version__}}
    if name not in works:
        works[name] = make(inputs, folder, name)
        # Compiles it.
        works[name].run()
    if what == "values":
        return {"values": works[name].values()}
    times = []
    for _ in range(int(what)):
        start = time.perf_counter()
        works[name].run()
        times.append((time.perf_counter() - start) * 1e3)
    return {"ms": times}


def main():
    folder = Path(sys.argv[1])
    inputs = json.loads((folder / "inputs.json").read_text())
    works = {}
    for request in sys.stdin:
        print(json.dumps(answer(inputs, folder, works, request)), flush=True)


if __name__ == "__main__":
    main()
