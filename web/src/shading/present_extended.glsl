// On a screen that shows more than white (HDR). Behind present.glsl.
//
// A canvas of WebGL2 has eight bits a channel, from 0 to 1. So the picture is written twice, one above the other: the upper half has the high bytes of
// 16-bit numbers, the lower half their low bytes, and render/hdr_screen.ts puts them together. 65535 is 4 of sRGB's curve continued, which is 25 times white.

uniform float u_peak;  // the brightest that is shown, in units of white: at least 1.5
in vec2 v_point;
out vec4 out_color;

/// The radiance, times the exposure, from which on there is more than an ordinary screen shows: where the curve brings a grey to 0.8 of white.
float knee() {
    return u_tonemap == 2 ? 1.97 : u_tonemap == 3 ? 2.74 : 0.86;
}

/// Without a curve and by Reinhard's: what the formula gives, up to the peak, so that everything below white is as on an ordinary screen. The other curves
/// end at white. There, a radiance of x times the knee's is shown 1 + (p - 1) t² / (1 + t + t²) times as bright, t = (x - 1) / (p - 1), p the peak: the same
/// below the knee, with the same slope at it, and p times as bright in the end.
vec3 on_screen(vec3 radiance) {
    vec3 v = max(radiance * u_exposure, 0.0), c = tonemapped(v);
    if (u_tonemap < 2) return srgb_encode(clamp(c, 0.0, u_peak));
    float t = max(0.0, max(v.r, max(v.g, v.b)) / knee() - 1.0) / (u_peak - 1.0), t2 = t * t;
    return srgb_encode(clamp(c, 0.0, 1.0) * (1.0 + (u_peak - 1.0) * t2 / (1.0 + t + t2)));
}

void main() {
    vec2 point = vec2(v_point.x, fract(2.0 * v_point.y));
    vec3 number = round(min(shown(point) / 4.0, 1.0) * 65535.0), high = floor(number / 256.0);
    out_color = vec4((v_point.y > 0.5 ? high : number - 256.0 * high) / 255.0, 1.0);
}
