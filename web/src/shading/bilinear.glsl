// A lat-long map of floats between its texels: it repeats in u and ends in v. Graphics cards do the same for half floats, with weights of 8 bits.

vec3 bilinear(sampler2D map, vec2 point) {
    ivec2 size = textureSize(map, 0);
    vec2 p = point * vec2(size) - 0.5;
    ivec2 low = ivec2(floor(p));
    vec2 t = p - vec2(low);
    int x0 = (low.x + size.x) % size.x, x1 = (low.x + 1) % size.x, y0 = max(low.y, 0), y1 = min(low.y + 1, size.y - 1);
    vec3 above = mix(texelFetch(map, ivec2(x0, y0), 0).rgb, texelFetch(map, ivec2(x1, y0), 0).rgb, t.x);
    vec3 below = mix(texelFetch(map, ivec2(x0, y1), 0).rgb, texelFetch(map, ivec2(x1, y1), 0).rgb, t.x);
    return mix(above, below, t.y);
}
