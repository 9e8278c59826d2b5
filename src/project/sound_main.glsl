void toyproofMain(out vec4 toyproof_color, in vec2 toyproof_position) {
    int toyproof_row = int(toyproof_position.y);
    int toyproof_block = toyproof_row / 512;
    int toyproof_index = toyproof_row % 512 * 512 + int(toyproof_position.x);
    float toyproof_start = float(toyproof_block * 262144) / 44100.0;
    float toyproof_time = toyproof_start + float(toyproof_index) / 44100.0;
    int toyproof_sample = toyproof_block * 262144 + toyproof_index;
    toyproof_color = vec4(mainSound(TOYPROOF_SOUND), 0.0, 1.0);
}
