"""Renders one frame of a shader with wgpu-shadertoy: `render.py SHADER WIDTH HEIGHT`."""

import pathlib
import sys

from wgpu_shadertoy import Shadertoy

shader, width, height = sys.argv[1:]
size = int(width), int(height)
text = pathlib.Path(shader).read_text()
image = Shadertoy(text, shader_type="glsl", resolution=size, offscreen=True).snapshot(0.0)
assert memoryview(image).shape[:2] == size[::-1]
