"""Paints one frame of a shader with wgpu-shadertoy: `paint.py SHADER WIDTH HEIGHT`."""

import pathlib
import sys

from wgpu_shadertoy import Shadertoy

shader, width, height = sys.argv[1:]
size = int(width), int(height)
text = pathlib.Path(shader).read_text()
picture = Shadertoy(text, shader_type="glsl", resolution=size, offscreen=True).snapshot(0.0)
assert memoryview(picture).shape[:2] == size[::-1]
