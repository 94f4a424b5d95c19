# SPDX-License-Identifier: MIT
"""Writes diffuse.gltf and metal.gltf: two spheres on a floor, a camera and a sun, and an environment beside them.

usage: make_scenes.py FOLDER
"""
import base64
import json
import math
import struct
import sys

FLOAT, UINT = 5126, 5125


def sphere(center, rows=64):
    """A unit sphere: positions, normals, indices."""
    normals = []
    for row in range(rows + 1):
        polar = math.pi * row / rows
        for column in range(2 * rows + 1):
            turn = math.pi * column / rows
            normals.append((math.sin(polar) * math.cos(turn), math.cos(polar), math.sin(polar) * math.sin(turn)))
    positions = [tuple(c + n for c, n in zip(center, normal)) for normal in normals]
    indices = []
    for row in range(rows):
        for column in range(2 * rows):
            a = row * (2 * rows + 1) + column
            c = a + 2 * rows + 1
            indices += [a, a + 1, c, a + 1, c + 1, c]
    return positions, normals, indices


def floor(half):
    corners = [(-half, 0, -half), (half, 0, -half), (-half, 0, half), (half, 0, half)]
    return corners, [(0, 1, 0)] * 4, [0, 2, 1, 1, 2, 3]


class Buffers:
    """The binary part of a glTF file."""

    def __init__(self):
        self.blob, self.views, self.accessors = b"", [], []

    def add(self, values, letter, kind, component, count, bounds=None):
        data = struct.pack("<%d%s" % (len(values), letter), *values)
        self.views.append({"buffer": 0, "byteOffset": len(self.blob), "byteLength": len(data)})
        self.blob += data
        accessor = {"bufferView": len(self.views) - 1, "componentType": component, "count": count, "type": kind}
        if bounds:
            accessor["min"], accessor["max"] = bounds
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def add_mesh(self, mesh, material):
        positions, normals, indices = mesh
        bounds = [[pick(p[axis] for p in positions) for axis in range(3)] for pick in (min, max)]
        attributes = {
            "POSITION": self.add([x for p in positions for x in p], "f", "VEC3", FLOAT, len(positions), bounds),
            "NORMAL": self.add([x for n in normals for x in n], "f", "VEC3", FLOAT, len(normals)),
        }
        index = self.add(indices, "I", "SCALAR", UINT, len(indices))
        return {"primitives": [{"attributes": attributes, "indices": index, "material": material}]}


def turned(yaw, pitch):
    """A quaternion x y z w: about X by `pitch`, then about Y by `yaw`, in degrees."""
    p, y = math.radians(pitch) / 2, math.radians(yaw) / 2
    return [math.cos(y) * math.sin(p), math.sin(y) * math.cos(p), -math.sin(y) * math.sin(p), math.cos(y) * math.cos(p)]


def material(color, metallic, roughness, specular):
    return {
        "pbrMetallicRoughness": {
            "baseColorFactor": [*color, 1],
            "metallicFactor": metallic,
            "roughnessFactor": roughness,
        },
        "extensions": {"KHR_materials_specular": {"specularFactor": specular}},
    }


def write(path, materials):
    buffers = Buffers()
    shapes = [sphere((0, 1, 0)), sphere((2.3, 1, -0.5)), floor(8)]
    meshes = [buffers.add_mesh(shape, i) for i, shape in enumerate(shapes)]
    nodes = [{"mesh": i} for i in range(len(meshes))]
    nodes.append({"camera": 0, "translation": [1, 1.8, 7], "rotation": turned(0, -7), "name": "Camera"})
    nodes.append({
        "rotation": turned(35, -50),
        "extensions": {"KHR_lights_punctual": {"light": 0}},
        "name": "Sun",
    })
    sun = {"type": "directional", "intensity": 2, "color": [1, 0.95, 0.9]}
    encoded = base64.b64encode(buffers.blob).decode()
    document = {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_specular"],
        "extensions": {"KHR_lights_punctual": {"lights": [sun]}},
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1, "aspectRatio": 1.5}}],
        "materials": materials,
        "meshes": meshes,
        "nodes": nodes,
        "accessors": buffers.accessors,
        "bufferViews": buffers.views,
        "buffers": [{
            "byteLength": len(buffers.blob),
            "uri": "data:application/octet-stream;base64," + encoded,
        }],
        "scenes": [{"nodes": list(range(len(nodes)))}],
        "scene": 0,
    }
    with open(path, "w", encoding="utf-8") as file:
        json.dump(document, file)


def main():
    folder = sys.argv[1]
    write(folder + "/diffuse.gltf", [
        material((0.8, 0.3, 0.2), 0, 1, 0),
        material((0.2, 0.5, 0.8), 0, 1, 0),
        material((0.6, 0.6, 0.6), 0, 1, 0),
    ])
    write(folder + "/metal.gltf", [
        material((0.9, 0.7, 0.4), 1, 0.3, 1),
        material((0.9, 0.9, 0.9), 1, 0.1, 1),
        material((0.6, 0.6, 0.6), 1, 0.6, 1),
    ])


if __name__ == "__main__":
    main()
