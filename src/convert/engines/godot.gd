extends Control
## Plays the passes of a ShaderToy shader. Each buffer has two viewports, which take turns: one is rendered,
## the other has the previous frame. Buffers have half-float components.

## The passes, in the order in which they are rendered.
const GRAPH := $graph

## The key codes of JavaScript, by the key of Godot. Letters, digits and the space have the same code.
const KEY_CODES := {
	KEY_BACKSPACE: 8, KEY_TAB: 9, KEY_ENTER: 13, KEY_KP_ENTER: 13, KEY_SHIFT: 16, KEY_CTRL: 17, KEY_ALT: 18,
	KEY_PAUSE: 19, KEY_CAPSLOCK: 20, KEY_ESCAPE: 27, KEY_SPACE: 32, KEY_PAGEUP: 33, KEY_PAGEDOWN: 34, KEY_END: 35,
	KEY_HOME: 36, KEY_LEFT: 37, KEY_UP: 38, KEY_RIGHT: 39, KEY_DOWN: 40, KEY_INSERT: 45, KEY_DELETE: 46,
	KEY_META: 91, KEY_KP_MULTIPLY: 106, KEY_KP_ADD: 107, KEY_KP_SUBTRACT: 109, KEY_KP_PERIOD: 110, KEY_KP_DIVIDE: 111,
	KEY_SEMICOLON: 186, KEY_EQUAL: 187, KEY_COMMA: 188, KEY_MINUS: 189, KEY_PERIOD: 190, KEY_SLASH: 191,
	KEY_QUOTELEFT: 192, KEY_BRACKETLEFT: 219, KEY_BACKSLASH: 220, KEY_BRACKETRIGHT: 221, KEY_APOSTROPHE: 222,
}

## The textures that channels read, by the id in the graph. The first row of their images is the bottom on
## ShaderToy if the graph says "vflip": flip such images when they are imported.
@export var media: Dictionary = {}

var frame := 0
var mouse := Vector4.ZERO
var is_held := false
var keys := Image.create_empty(256, 3, false, Image.FORMAT_R8)
var keyboard := ImageTexture.create_from_image(keys)
var viewports := {}
var pass_materials: Array[ShaderMaterial] = []
## The size of the viewports.
var resolution := Vector2i.ZERO
var opaque_black := _black(1.0)


func _ready() -> void:
	var folder: String = get_script().resource_path.get_base_dir()
	for entry: Dictionary in GRAPH.passes:
		var pass_material := ShaderMaterial.new()
		pass_material.shader = load(folder.path_join(entry.file))
		pass_materials.append(pass_material)
		if entry.target == "image":
			viewports.image = [_viewport(pass_material, false)]
		else:
			viewports[entry.target] = [_viewport(pass_material, true), _viewport(pass_material, true)]
	var shown := TextureRect.new()
	shown.texture = viewports.image[0].get_texture()
	shown.expand_mode = TextureRect.EXPAND_IGNORE_SIZE
	shown.mouse_filter = MOUSE_FILTER_IGNORE
	shown.set_anchors_preset(PRESET_FULL_RECT)
	add_child(shown)


func _viewport(pass_material: ShaderMaterial, is_buffer: bool) -> SubViewport:
	var viewport := SubViewport.new()
	viewport.use_hdr_2d = is_buffer
	viewport.transparent_bg = is_buffer
	viewport.disable_3d = true
	viewport.render_target_update_mode = SubViewport.UPDATE_DISABLED
	var surface := ColorRect.new()
	surface.material = pass_material
	surface.set_anchors_preset(PRESET_FULL_RECT)
	viewport.add_child(surface)
	add_child(viewport)
	return viewport


static func _black(alpha: float) -> ImageTexture:
	var pixel := Image.create_empty(1, 1, false, Image.FORMAT_RGBA8)
	pixel.fill(Color(0.0, 0.0, 0.0, alpha))
	return ImageTexture.create_from_image(pixel)


## Gives all viewports a new size. In this frame, they only get back what they had: the lower left part of it.
func _resize() -> void:
	for target: Array in viewports.values():
		for viewport: SubViewport in target:
			var copy := TextureRect.new()
			if resolution != Vector2i.ZERO:
				copy.texture = ImageTexture.create_from_image(viewport.get_texture().get_image())
			copy.material = CanvasItemMaterial.new()
			copy.material.blend_mode = CanvasItemMaterial.BLEND_MODE_PREMULT_ALPHA
			viewport.get_child(0).hide()
			viewport.add_child(copy)
			viewport.size = Vector2i(size)
			viewport.render_target_clear_mode = SubViewport.CLEAR_MODE_ONCE
			viewport.render_target_update_mode = SubViewport.UPDATE_ONCE
	resolution = Vector2i(size)


func _process(delta: float) -> void:
	if size.x < 2.0 or size.y < 2.0:
		return  # Not laid out yet; a viewport has two pixels at least.
	if resolution != Vector2i(size):
		_resize()
		return
	var turn := frame % 2
	var now := Time.get_datetime_dict_from_system()
	var seconds: float = fmod(Time.get_unix_time_from_system(), 1.0) + now.second + 60 * now.minute + 3600 * now.hour
	for target: Array in viewports.values():
		for viewport: SubViewport in target:
			viewport.render_target_update_mode = SubViewport.UPDATE_DISABLED
			viewport.get_child(0).show()
			if viewport.get_child_count() > 1:
				viewport.get_child(1).free()
		target[turn % target.size()].render_target_update_mode = SubViewport.UPDATE_ONCE
	for pass_number: int in GRAPH.passes.size():
		var pass_material := pass_materials[pass_number]
		pass_material.set_shader_parameter("iTimeDelta", delta)
		pass_material.set_shader_parameter("iFrame", frame)
		pass_material.set_shader_parameter("iFrameRate", Engine.get_frames_per_second())
		pass_material.set_shader_parameter("iMouse", mouse)
		pass_material.set_shader_parameter("iDate", Vector4(now.year, now.month - 1, now.day, seconds))
		var inputs: Array = GRAPH.passes[pass_number].inputs
		for channel in 4:
			pass_material.set_shader_parameter("iChannel%d" % channel, _texture(inputs[channel], turn))
	frame += 1
	mouse.w = -absf(mouse.w)
	for key in 256:
		keys.set_pixel(key, 1, Color.BLACK)


func _texture(input: Variant, turn: int) -> Texture:
	if input == null:
		return opaque_black
	match input.source:
		"buffer":
			var rendered := turn if input.frame == "this" else 1 - turn
			return viewports[input.buffer][rendered].get_texture() if viewports.has(input.buffer) else _black(0.0)
		"keyboard":
			keyboard.update(keys)
			return keyboard
	var medium: Texture = media.get(input.id)
	return medium if medium != null else opaque_black


func _input(event: InputEvent) -> void:
	if event is InputEventKey and not event.echo:
		var key: int = event.keycode
		var code: int = KEY_CODES.get(key, -1)
		if key >= KEY_0 and key <= KEY_9 or key >= KEY_A and key <= KEY_Z:
			code = key
		elif key >= KEY_F1 and key <= KEY_F12:
			code = 112 + key - KEY_F1
		elif key >= KEY_KP_0 and key <= KEY_KP_9:
			code = 96 + key - KEY_KP_0
		if code > 0:
			keys.set_pixel(code, 0, Color.WHITE if event.pressed else Color.BLACK)
			if event.pressed:
				keys.set_pixel(code, 1, Color.WHITE)
				keys.set_pixel(code, 2, Color.WHITE - keys.get_pixel(code, 2))


func _gui_input(event: InputEvent) -> void:
	# y points up in ShaderToy. The click is positive while the button is down, and its y in the first frame.
	if event is InputEventMouseButton and event.button_index == MOUSE_BUTTON_LEFT:
		is_held = event.pressed
		if is_held:
			mouse = Vector4(event.position.x, size.y - event.position.y, event.position.x, size.y - event.position.y)
		else:
			mouse.z = -absf(mouse.z)
	elif event is InputEventMouseMotion and is_held:
		mouse.x = event.position.x
		mouse.y = size.y - event.position.y
