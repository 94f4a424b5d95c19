#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the seeds of the fuzzers: small valid files that between them use every feature of the loaders.

    tests/fuzz/make_corpus.py [FOLDER]      (default: the folder corpus beside this script)
"""
import base64
import json
import pathlib
import struct
import sys
import zlib


def ply(format_name, vertex_properties, vertices, faces, extra=b"", comment="seed"):
    """A PLY file; `vertices` and `faces` are already encoded."""
    header = ["ply", f"format {format_name} 1.0", f"comment {comment}", f"element vertex {vertices[0]}"]
    header += [f"property {p}" for p in vertex_properties]
    header += [f"element face {faces[0]}", "property list uchar int vertex_indices"]
    return "\n".join(header).encode() + b"\n" + extra + b"end_header\n" + vertices[1] + faces[1]


def ply_seeds():
    square = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    xyz = ["float x", "float y", "float z"]
    text = "".join("%d %d %d\n" % p for p in square).encode()
    yield "ascii.ply", ply("ascii", xyz, (4, text), (1, b"4 0 1 2 3\n"))
    for name, order in (("little", "<"), ("big", ">")):
        packed = b"".join(struct.pack(order + "3f", *p) for p in square)
        quad = struct.pack(order + "B4i", 4, 0, 1, 2, 3)
        yield f"{name}.ply", ply(f"binary_{name}_endian", xyz, (4, packed), (1, quad))
    full = b"".join(struct.pack("<3d3f4Bff", *p, 0, 0, 1, 255, 128, 0, 255, p[0], p[1]) for p in square)
    properties = ["double x", "double y", "double z", "float nx", "float ny", "float nz", "uchar red", "uchar green",
                  "uchar blue", "uchar alpha", "float s", "float t"]
    triangles = struct.pack("<B3iB3i", 3, 0, 1, 2, 3, 0, 2, 3)
    yield "attributes.ply", ply("binary_little_endian", properties, (4, full), (2, triangles))
    yield "faces_first.ply", (
        b"ply\r\nformat ascii 1.0\r\nobj_info faces first\r\nelement face 1\r\nproperty uchar flag\r\n"
        b"property list ushort uint8 vertex_index\r\nelement vertex 3\r\nproperty int16 z\r\nproperty int16 x\r\n"
        b"property list uint8 float32 skipped\r\nproperty int16 y\r\nelement edge 1\r\nproperty int a\r\n"
        b"property int b\r\nend_header\r\n7 3 0 1 2\r\n0 0 0 0\r\n0 1 2 0.5 0.5 0\r\n0 0 0 1\r\n0 1\r\n")


def obj_seeds():
    yield "triangle.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
    yield "full.obj", (
        b"# a square and a pentagon\nmtllib fuzz.obj\no part\ng a b\ns 1\n"
        b"v 0 0 0\nv 1 0 0 1.0\nv 1 1 0 0.5 0.5 0.5\nv 0 1 0\nv .5 1.5e0 +0\nvt 0 0\nvt 1 0 0\nvt 1 1\nvt 0\n"
        b"vn 0 0 1\nusemtl red\nf 1/1/1 2/2/1 \\\n 3/3/1 4/4/1\nusemtl other\nf -5//-1 -4//-1 -3//-1 5//1 4//1\n"
        b"l 1 2\np 1\nf 1/1 2/2 3/3\n"
        b"newmtl red\nKd 1 0 0\nKe 0 0 2\nNs 100\nPr 0.5\nPm 1\nd 0.5\nmap_d -clamp on mask.png\n"
        b"map_Kd -s 2 2 1 -o 0.5 -clamp on texture.png\nnewmtl other\nKd spectral file.rfl 1\n"
        b"Ni 1.3\nTf 1 .5 0\nillum 7\nPc 1\nPcr .5\n")
    yield "colors.obj", b"v 0 0 0 1 0 .5\nv 1 0 0 0 1 0 # green\nv 0 1 0\nf 1 2 3\n"
    yield "crlf.obj", b"v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3 # end\r\n"


def stl_seeds():
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    binary = b"solid binary all the same".ljust(80, b"\0") + struct.pack("<I", len(faces))
    text = "solid seed of a tetrahedron\n"
    for face in faces:
        binary += struct.pack("<3f", 0, 0, 0) + b"".join(struct.pack("<3f", *corners[i]) for i in face) + b"\0\0"
        text += " facet normal nan 0 0\n  outer loop\n"
        text += "".join("   vertex %g %g %ge0\n" % corners[i] for i in face)
        text += "  endloop\n endfacet\n"
    yield "binary.stl", binary
    yield "ascii.stl", (text + "endsolid seed\n").encode()


def png(width, height, depth, color_type, rows):
    """A PNG of the rows, each given as its bytes."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">2I5B", width, height, depth, color_type, 0, 0, 0)
    data = zlib.compress(b"".join(b"\0" + row for row in rows), 9)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", data) + chunk(b"IEND", b"")


def exr(width, height, rows):
    """A single-channel, uncompressed, 32-bit float OpenEXR file."""
    def attribute(name, kind, value):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<2i", 20000630, 2)
    header += attribute(b"channels", b"chlist", b"Y\0" + struct.pack("<iB3x2i", 2, 0, 1, 1) + b"\0")
    header += attribute(b"compression", b"compression", b"\0")
    header += attribute(b"dataWindow", b"box2i", window) + attribute(b"displayWindow", b"box2i", window)
    header += attribute(b"lineOrder", b"lineOrder", b"\0")
    header += attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
    header += attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0))
    header += attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0"
    lines = [struct.pack("<2i", y, 4 * width) + struct.pack("<%df" % width, *rows[y]) for y in range(height)]
    offset = len(header) + 8 * height
    table = b""
    for line in lines:
        table += struct.pack("<Q", offset)
        offset += len(line)
    return header + table + b"".join(lines)


def tiff(width, height, rows):
    """A single-strip, uncompressed, 32-bit float TIFF."""
    data = b"".join(struct.pack("<%df" % width, *row) for row in rows)
    tags = [(256, 3, width), (257, 3, height), (258, 3, 32), (259, 3, 1), (262, 3, 1), (273, 4, 8), (277, 3, 1),
            (278, 3, height), (279, 4, len(data)), (339, 3, 3)]
    directory = struct.pack("<H", len(tags))
    directory += b"".join(struct.pack("<2H2I", tag, kind, 1, value) for tag, kind, value in tags)
    return b"II*\0" + struct.pack("<I", 8 + len(data)) + data + directory + struct.pack("<I", 0)


def height_map_seeds():
    yield "grey8.png", png(3, 2, 8, 0, [bytes([0, 128, 255]), bytes([255, 128, 0])])
    yield "grey16.png", png(2, 2, 16, 0, [struct.pack(">2H", 0, 65535), struct.pack(">2H", 1, 256)])
    yield "grey_alpha8.png", png(2, 2, 8, 4, [bytes([9, 255, 8, 0]), bytes([7, 1, 6, 2])])
    yield "grey1.png", png(8, 2, 1, 0, [b"\x55", b"\xaa"])
    yield "rgb8.png", png(2, 2, 8, 2, [bytes([1, 1, 1, 2, 2, 2]), bytes([3, 3, 3, 4, 4, 4])])
    rows = [[0.0, 0.5, 1.0], [-1.0, 2.0, 1e-3]]
    yield "float.exr", exr(3, 2, rows)
    yield "float.tif", tiff(3, 2, rows)


def hdr(width, height, texels, packed):
    """A Radiance picture of RGBE texels, row by row; `packed`: by run lengths, of single bytes here."""
    data = b"#?RADIANCE\n# seed\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width)
    for y in range(height):
        row = texels[y * width:(y + 1) * width]
        if packed:
            data += bytes([2, 2, width >> 8, width & 255])
            for channel in range(4):
                data += bytes([width]) + bytes(texel[channel] for texel in row)
        else:
            data += b"".join(bytes(texel) for texel in row)
    return data


def environment_seeds():
    yield "plain.hdr", hdr(4, 2, [(128, 64, 32, 129), (0, 0, 0, 0)] * 4, False)
    yield "packed.hdr", hdr(8, 4, [(200, 100 + i, 50, 128) for i in range(32)], True)
    yield "run.hdr", (b"#?RGBE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 8\n"
                      + 2 * (bytes([2, 2, 0, 8]) + bytes([136, 90, 136, 80, 136, 70, 136, 130])))
    yield "grey.exr", exr(4, 2, [[0.0, 0.5, 1.0, 3.0], [4.0, 2.0, 1e-3, 1.0]])
    yield "rgb8.png", png(2, 1, 8, 2, [bytes([255, 128, 0, 2, 2, 2])])


class Gltf:
    """A glTF document under construction, with its single buffer."""

    def __init__(self):
        self.data = b""
        self.document = {"asset": {"version": "2.0"}, "scene": 0, "bufferViews": [], "accessors": []}

    def view(self, data):
        self.data += b"\0" * (-len(self.data) % 4)
        self.document["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)})
        self.data += data
        return len(self.document["bufferViews"]) - 1

    def accessor(self, kind, component, count, data=None, **more):
        entry = {"componentType": component, "count": count, "type": kind, **more}
        if data is not None:
            entry["bufferView"] = self.view(data)
        self.document["accessors"].append(entry)
        return len(self.document["accessors"]) - 1

    def floats(self, kind, values, **more):
        per = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}[kind]
        return self.accessor(kind, 5126, len(values) // per, struct.pack("<%df" % len(values), *values), **more)

    def gltf(self):
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        document = dict(self.document, buffers=[{"byteLength": len(self.data), "uri": uri}])
        return json.dumps(document, separators=(",", ":")).encode()

    def glb(self):
        document = dict(self.document, buffers=[{"byteLength": len(self.data)}])
        text = json.dumps(document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        data = self.data + b"\0" * (-len(self.data) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
        return b"glTF" + struct.pack("<2I", 2, 12 + len(chunks)) + chunks


def gltf_triangle(texture):
    scene = Gltf()
    attributes = {"POSITION": scene.floats("VEC3", [0, 0, 0, 1, 0, 0, 0, 1, 0], min=[0, 0, 0], max=[1, 1, 0]),
                  "TEXCOORD_0": scene.floats("VEC2", [0, 0, 1, 0, 0, 1])}
    indices = scene.accessor("SCALAR", 5123, 3, struct.pack("<3H", 0, 1, 2))
    primitive = {"attributes": attributes, "indices": indices, "material": 0}
    material = {"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 1], "metallicFactor": 0},
                "alphaMode": "MASK", "doubleSided": True}
    if texture:
        image = scene.view(png(1, 1, 8, 2, [b"\xff\x80\x00"]))
        scene.document["images"] = [{"bufferView": image, "mimeType": "image/png"}]
        scene.document["textures"] = [{"source": 0}]
        material["pbrMetallicRoughness"]["baseColorTexture"] = {"index": 0}
    scene.document.update(
        materials=[material], meshes=[{"primitives": [primitive]}],
        cameras=[{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}],
        nodes=[{"mesh": 0, "children": [1]}, {"camera": 0, "translation": [0, 0, 3]}], scenes=[{"nodes": [0]}])
    return scene


def gltf_layers():
    """All that the material extensions say, each texture of another kind."""
    scene = gltf_triangle(True)
    shifted = {"index": 0, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0], "texCoord": 0}}}
    layers = {
        "KHR_materials_ior": {"ior": 1.25},
        "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 0.5, 0],
                                   "specularTexture": {"index": 0}, "specularColorTexture": {"index": 0}},
        "KHR_materials_transmission": {"transmissionFactor": 0.5, "transmissionTexture": shifted},
        "KHR_materials_volume": {"thicknessFactor": 1, "attenuationColor": [0, 0.5, 1], "attenuationDistance": 2},
        "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.25,
                                    "clearcoatTexture": {"index": 0, "texCoord": 1},
                                    "clearcoatRoughnessTexture": {"index": 0},
                                    "clearcoatNormalTexture": {"index": 0, "scale": 0.5}}}
    scene.document["materials"][0]["extensions"] = layers
    scene.document["extensionsUsed"] = [*layers, "KHR_texture_transform"]
    return scene


def gltf_morph():
    """Two targets, one sparse, with weights animated in all three ways."""
    scene = Gltf()
    attributes = {"POSITION": scene.floats("VEC3", [0, 0, 0, 1, 0, 0, 0, 1, 0], min=[0, 0, 0], max=[1, 1, 0])}
    dense = scene.floats("VEC3", [0, 0, 1] * 3)
    sparse = scene.accessor("VEC3", 5126, 3, sparse={
        "count": 1, "indices": {"bufferView": scene.view(b"\1"), "componentType": 5121},
        "values": {"bufferView": scene.view(struct.pack("<3f", 0, 0, 2))}})
    times = scene.floats("SCALAR", [0, 1], min=[0], max=[1])
    samplers = [{"input": times, "output": scene.floats("SCALAR", [0, 1, 1, 0])},
                {"input": times, "output": scene.floats("VEC3", [0, 0, 0, 1, 1, 1]), "interpolation": "STEP"},
                {"input": times, "output": scene.floats("VEC4", [0, 0, 0, 1] * 6), "interpolation": "CUBICSPLINE"}]
    paths = ["weights", "translation", "rotation"]
    scene.document.update(
        meshes=[{"primitives": [{"attributes": attributes, "targets": [{"POSITION": dense}, {"POSITION": sparse}]}],
                 "weights": [0.5, 0], "extras": {"targetNames": ["up", "more"]}}],
        animations=[{"samplers": samplers,
                     "channels": [{"sampler": i, "target": {"node": 0, "path": p}} for i, p in enumerate(paths)]}],
        nodes=[{"mesh": 0}], scenes=[{"nodes": [0]}])
    return scene


def gltf_skin():
    scene = Gltf()
    attributes = {"POSITION": scene.floats("VEC3", [0, 0, 0, 1, 0, 0, 0, 1, 0], min=[0, 0, 0], max=[1, 1, 0]),
                  "JOINTS_0": scene.accessor("VEC4", 5121, 3, bytes([0, 1, 0, 0] * 3)),
                  "WEIGHTS_0": scene.accessor("VEC4", 5121, 3, bytes([128, 127, 0, 0] * 3), normalized=True)}
    identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    scene.document.update(
        meshes=[{"primitives": [{"attributes": attributes, "mode": 5}]}],
        skins=[{"joints": [1, 2], "inverseBindMatrices": scene.floats("MAT4", identity * 2)}],
        nodes=[{"mesh": 0, "skin": 0}, {"children": [2]}, {"matrix": identity}], scenes=[{"nodes": [0, 1]}],
        extensionsUsed=["KHR_lights_punctual"],
        extensions={"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {"outerConeAngle": 0.5}}]}})
    scene.document["nodes"].append({"extensions": {"KHR_lights_punctual": {"light": 0}}})
    scene.document["scenes"][0]["nodes"].append(3)
    return scene


def gltf_facets():
    """A strip of two facets that share an edge, skinned and morphed; indices with sparse elements alone."""
    scene = Gltf()
    attributes = {"POSITION": scene.accessor("VEC3", 5122, 4, struct.pack("<12h", 0, 0, 0, 9, 0, 0, 0, 9, 0, 9, 9, 9)),
                  "JOINTS_0": scene.accessor("VEC4", 5121, 4, bytes([0, 0, 0, 0] * 4)),
                  "WEIGHTS_0": scene.accessor("VEC4", 5123, 4, struct.pack("<16H", *[65535, 0, 0, 0] * 4),
                                              normalized=True),
                  "COLOR_0": scene.accessor("VEC4", 5121, 4, bytes(range(16)), normalized=True)}
    scene.document["bufferViews"][0].update(byteLength=24)
    indices = scene.accessor("SCALAR", 5121, 6, sparse={
        "count": 5, "indices": {"bufferView": scene.view(bytes([1, 2, 3, 4, 5])), "componentType": 5121},
        "values": {"bufferView": scene.view(bytes([1, 2, 2, 1, 3]))}})
    target = {"POSITION": scene.floats("VEC3", [0] * 9 + [0, 0, 1]), "NORMAL": scene.floats("VEC3", [0, 1, 0] * 4)}
    scene.document.update(
        meshes=[{"primitives": [{"attributes": attributes, "indices": indices, "targets": [target],
                                 "extras": {"targetNames": ["bend"]}}]}],
        skins=[{"joints": [0]}], nodes=[{"mesh": 0, "skin": 0, "weights": [1]}], scenes=[{"nodes": [0]}],
        extensionsUsed=["KHR_mesh_quantization"], extensionsRequired=["KHR_mesh_quantization"])
    return scene


def main():
    beside = pathlib.Path(__file__).resolve().parent / "corpus"
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else beside
    scenes = [("triangle", gltf_triangle(False)), ("texture", gltf_triangle(True)), ("layers", gltf_layers()),
              ("morph", gltf_morph()), ("skin", gltf_skin()), ("facets", gltf_facets())]
    formats = {"ply": ply_seeds(), "obj": obj_seeds(), "stl": stl_seeds(), "height_map": height_map_seeds(),
               "environment": environment_seeds(),
               "gltf": ((f"{name}.gltf", scene.gltf()) for name, scene in scenes),
               "glb": ((f"{name}.glb", scene.glb()) for name, scene in scenes)}
    for folder, seeds in formats.items():
        (root / folder).mkdir(parents=True, exist_ok=True)
        for name, data in seeds:
            (root / folder / name).write_bytes(data)


if __name__ == "__main__":
    main()
