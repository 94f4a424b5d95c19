# SPDX-License-Identifier: MIT
"""Renders a glTF file by path tracing in Blender's Cycles, as `lodestone render --integrator path` does: the same camera, lights
and environment, as many bounces, no clamping, no denoiser, a box filter, linear values.

usage: blender -b --python render_cycles.py -- SCENE.gltf ENVIRONMENT OUT.exr WIDTH HEIGHT SAMPLES BOUNCES SUN LAMBERT
SUN: W/m2 of its one light; the importer scales them. LAMBERT 1: materials become Lambert's in their base colour, for what the importer
makes of a rough dielectric is Disney's diffuse, which is brighter at grazing angles.
"""
import sys

import numpy

if not hasattr(numpy, "bool"):
    numpy.bool = bool  # the importer of Blender 3.4 still says so
import bpy


def set_up_cycles(scene, width, height, samples, bounces):
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = samples
    cycles.use_denoising = cycles.use_adaptive_sampling = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = bounces
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.pixel_filter_type = "BOX"
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.view_settings.view_transform = "Raw"
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"


def make_lambert(material):
    nodes = material.node_tree.nodes
    for principled in [node for node in nodes if node.type == "BSDF_PRINCIPLED"]:
        diffuse = nodes.new("ShaderNodeBsdfDiffuse")
        diffuse.inputs["Color"].default_value = principled.inputs["Base Color"].default_value
        output = next(node for node in nodes if node.type == "OUTPUT_MATERIAL")
        material.node_tree.links.new(diffuse.outputs[0], output.inputs["Surface"])


def light_by(scene, environment):
    world = scene.world = bpy.data.worlds.new("environment")
    world.use_nodes = True
    nodes = world.node_tree.nodes
    background = next(node for node in nodes if node.type == "BACKGROUND")
    texture = nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load(environment)
    world.node_tree.links.new(texture.outputs["Color"], background.inputs["Color"])


def main():
    arguments = sys.argv[sys.argv.index("--") + 1:]
    gltf, environment, out = arguments[:3]
    width, height, samples, bounces = map(int, arguments[3:7])
    sun, lambert = float(arguments[7]), arguments[8] == "1"
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=gltf)
    scene = bpy.context.scene
    set_up_cycles(scene, width, height, samples, bounces)
    for thing in bpy.data.objects:
        if thing.type == "CAMERA":
            scene.camera = thing
        if thing.type == "LIGHT":
            thing.data.energy, thing.data.angle = sun, 0
    if lambert:
        for material in bpy.data.materials:
            if material.use_nodes:
                make_lambert(material)
    light_by(scene, environment)
    scene.render.filepath = out
    bpy.ops.render.render(write_still=True)


main()
