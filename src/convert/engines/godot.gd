extends Control
## Plays the passes of a ShaderToy shader. Each buffer has two viewports, which take turns: one is rendered,
## the other has the previous frame. Buffers have half-float components.

## The passes, in the order in which they are rendered.
const GRAPH := $graph

## The key codes of JavaScript, for keys that have other codes in Godot.
const KEY_CODES := {
	KEY_BACKSPACE: 8, KEY_TAB: 9, KEY_ENTER: 13, KEY_SHIFT: 16, KEY_CTRL: 17, KEY_ALT: 18, KEY_ESCAPE: 27,
	KEY_LEFT: 37, KEY_UP: 38, KEY_RIGHT: 39, KEY_DOWN: 40, KEY_DELETE: 46,
}

## The textures that channels read, by the id in the graph. The first row of their images is the bottom on
## ShaderToy if the graph says "vflip": flip such images when they are imported.
@export var media: Dictionary = {}

var frame := 0
var mouse := Vector4.ZERO
var keys := Image.create_empty(256, 3, false, Image.FORMAT_R8)
var keyboard := ImageTexture.create_from_image(keys)
var viewports := {}
var materials: Array[ShaderMaterial] = []


func _ready() -> void:
	var folder: String = get_script().resource_path.get_base_dir()
	for entry in GRAPH.passes:
		var material := ShaderMaterial.new()
		material.shader = load(folder.path_join(entry.file))
		materials.append(material)
		if entry.target == "image":
			add_child(_surface(material))
		else:
			viewports[entry.target] = [_viewport(material), _viewport(material)]


func _surface(material: ShaderMaterial) -> ColorRect:
	var surface := ColorRect.new()
	surface.material = material
	surface.mouse_filter = MOUSE_FILTER_IGNORE
	surface.set_anchors_preset(PRESET_FULL_RECT)
	return surface


func _viewport(material: ShaderMaterial) -> SubViewport:
	var viewport := SubViewport.new()
	viewport.size = Vector2i(size)
	viewport.use_hdr_2d = true
	viewport.transparent_bg = true
	viewport.disable_3d = true
	viewport.render_target_clear_mode = SubViewport.CLEAR_MODE_ONCE
	viewport.render_target_update_mode = SubViewport.UPDATE_ONCE if frame == 0 else SubViewport.UPDATE_DISABLED
	viewport.add_child(_surface(material))
	add_child(viewport)
	return viewport


func _process(delta: float) -> void:
	var turn := frame % 2
	var now := Time.get_datetime_dict_from_system()
	var seconds: float = fmod(Time.get_unix_time_from_system(), 1.0) + now.second + 60 * now.minute + 3600 * now.hour
	for target in viewports:
		for viewport in viewports[target]:
			viewport.size = Vector2i(size)
			viewport.render_target_update_mode = SubViewport.UPDATE_DISABLED
		viewports[target][turn].render_target_update_mode = SubViewport.UPDATE_ONCE
	for pass_number in GRAPH.passes.size():
		var material := materials[pass_number]
		material.set_shader_parameter("iTimeDelta", delta)
		material.set_shader_parameter("iFrame", frame)
		material.set_shader_parameter("iFrameRate", Engine.get_frames_per_second())
		material.set_shader_parameter("iMouse", mouse)
		material.set_shader_parameter("iDate", Vector4(now.year, now.month - 1, now.day, seconds))
		var inputs: Array = GRAPH.passes[pass_number].inputs
		for channel in 4:
			if inputs[channel] != null:
				material.set_shader_parameter("iChannel%d" % channel, _texture(inputs[channel], turn))
	frame += 1
	mouse.w = -absf(mouse.w)
	for key in 256:
		keys.set_pixel(key, 1, Color.BLACK)


func _texture(input: Dictionary, turn: int) -> Texture2D:
	match input.source:
		"buffer":
			var rendered := turn if input.frame == "this" else 1 - turn
			return viewports[input.buffer][rendered].get_texture() if viewports.has(input.buffer) else null
		"keyboard":
			keyboard.update(keys)
			return keyboard
	return media.get(input.id)


func _input(event: InputEvent) -> void:
	if event is InputEventKey and not event.echo:
		var code: int = KEY_CODES.get(event.keycode, event.keycode)
		if code < 256:
			keys.set_pixel(code, 0, Color.WHITE if event.pressed else Color.BLACK)
			if event.pressed:
				keys.set_pixel(code, 1, Color.WHITE)
				keys.set_pixel(code, 2, Color.WHITE - keys.get_pixel(code, 2))


func _gui_input(event: InputEvent) -> void:
	# y points up in ShaderToy. The click is positive while the button is down, and its y in the first frame.
	if event is InputEventMouseButton and event.button_index == MOUSE_BUTTON_LEFT:
		var at := Vector2(event.position.x, size.y - event.position.y)
		if event.pressed:
			mouse = Vector4(at.x, at.y, at.x, at.y)
		else:
			mouse.z = -absf(mouse.z)
	elif event is InputEventMouseMotion and mouse.z > 0.0:
		mouse.x = event.position.x
		mouse.y = size.y - event.position.y
