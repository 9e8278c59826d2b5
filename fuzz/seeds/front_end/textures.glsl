vec4 read(sampler2D s, vec2 p) { return texture(s, p) + textureLod(s, p, 0.0); }
void mainImage(out vec4 o, in vec2 p) {
    vec2 uv = p / iResolution.xy; ivec2 size = textureSize(iChannel0, 0);
    o = read(iChannel0, uv) + texelFetch(iChannel0, ivec2(p) % size, 0) + texture(iChannel1, vec3(uv, 1.0));
    o += textureGrad(iChannel2, uv, dFdx(uv), dFdy(uv)) + textureOffset(iChannel2, uv, ivec2(1, -1), 0.5);
    o += texelFetchOffset(iChannel2, ivec2(0), 0, ivec2(2)) + textureProj(iChannel2, vec3(p, 2.0)) * iChannelResolution[1].x;
    o.a = iChannelTime[2] + iMouse.z + iDate.w + iSampleRate + iTimeDelta + iFrameRate + float(iFrame);
}
