var<private> gl_FragCoord: vec4f; //? position
//? position
$shader
//? iMouse
// The mouse in ShaderToy's coordinates, with the current position in place of that of the click. //? iMouse
fn shadertoy_mouse() -> vec4f { //? iMouse
    let position = vec2f(f32(mouse.pos.x), f32(textureDimensions(screen).y) - f32(mouse.pos.y)); //? iMouse
    return vec4f(position, select(0.0 - position, position, mouse.click != 0)); //? iMouse
} //? iMouse

@compute @workgroup_size(16, 16)
fn main_image(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(screen);
    if id.x >= size.x || id.y >= size.y {
        return;
    }
    // Row 0 is the top here, and the bottom in GLSL.
    let frag_coord = vec2f(f32(id.x) + 0.5, f32(size.y - id.y) - 0.5);
    gl_FragCoord = vec4f(frag_coord, 0.5, 1.0); //? position
    $startup(); //? startup
    var color: vec4f; //? out
    var color: vec4f = vec4f(0.0, 0.0, 0.0, 1.0); //? inout
    $main_image(&color, frag_coord);
    // The screen holds linear colors; ShaderToy shows its values as they are.
    textureStore(screen, vec2i(id.xy), vec4f(pow(saturate(color.xyz), vec3f(2.2)), 1.0));
}
