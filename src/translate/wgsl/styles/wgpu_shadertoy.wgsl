var<private> gl_FragCoord: vec4f; //? position
//? position
$shader

fn shader_main(frag_coord: vec2f) -> vec4f {
    gl_FragCoord = vec4f(frag_coord, 0.5, 1.0); //? position
    $startup(); //? startup
    var color: vec4f; //? out
    var color: vec4f = vec4f(0.0, 0.0, 0.0, 1.0); //? inout
    $main_image(&color, frag_coord);
    return vec4f(color.xyz, 1.0); //? image
    return color; //? buffer
}
