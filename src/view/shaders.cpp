#include "view/shaders.h"

namespace dihaptic::view::shaders {

// Writes the first two moments of the depth below the light. A quarter of the squared slope is the
// variance of the depth within a texel if the surface is tilted (README.md). The slope is limited
// to 2: steeper surfaces hardly receive light, and their variance would only let light through.
const char* const kMomentsVertex = R"(
layout(location = 0) in vec3 position;
uniform mat4 world_from_model;
uniform mat4 light_from_world;  // x, y from -1 to 1, z the depth [m]
uniform float depth_range;
out float depth;
void main() {
    vec4 q = light_from_world * world_from_model * vec4(position, 1);
    depth = q.z;
    gl_Position = vec4(q.xy, q.z / depth_range, 1);
}
)";

const char* const kMomentsFragment = R"(
in float depth;
uniform float texel;  // [m]
layout(location = 0) out vec2 moments;
void main() {
    vec2 slope = min(abs(vec2(dFdx(depth), dFdy(depth))), 2.0 * texel);
    moments = vec2(depth, depth * depth + 0.25 * dot(slope, slope));
}
)";

const char* const kBlurVertex = R"(
out vec2 uv;
void main() {
    uv = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2;
    gl_Position = vec4(2 * uv - 1, 0, 1);
}
)";

// The binomial weights 1 4 6 4 1 approximate a Gaussian with a standard deviation of one texel. Two
// neighbours are read at once, at the point where linear interpolation weights them in this ratio.
const char* const kBlurFragment = R"(
in vec2 uv;
uniform sampler2D source;
uniform vec2 texel;  // a step along the row or the column
layout(location = 0) out vec2 moments;
void main() {
    moments = (6.0 * texture(source, uv).rg +
               5.0 * texture(source, uv + 1.2 * texel).rg +
               5.0 * texture(source, uv - 1.2 * texel).rg) / 16.0;
}
)";

const char* const kBackground = R"(
uniform vec2 corner;  // corner of this part of the picture [pixels]
uniform vec2 size;
vec3 background() {
    vec2 at = (gl_FragCoord.xy - corner) / size;
    vec3 colour = mix(vec3(0.50, 0.54, 0.59), vec3(0.86, 0.89, 0.92), smoothstep(0.0, 1.0, at.y));
    vec2 off = at - vec2(0.5, 0.6);
    return colour * (1.06 - 0.35 * dot(off, off));
}
vec3 encode(vec3 linear) {  // sRGB, IEC 61966-2-1; a hair of noise hides its steps
    float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    vec3 c = clamp(linear, 0.0, 1.0);
    c = mix(12.92 * c, 1.055 * pow(c, vec3(1 / 2.4)) - 0.055, step(0.0031308, c));
    return c + (noise - 0.5) / 255.0;
}
)";

const char* const kBackgroundFragment = R"(
out vec4 colour;
void main() { colour = vec4(encode(background()), 1); }
)";

const char* const kSurfaceVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 world_from_model;
uniform mat4 clip_from_world;
out vec3 p_W;
out vec3 n_W;
#ifdef LOOKS
layout(location = 2) in vec3 own;
out vec3 p_B;
out vec3 n_B;
out vec3 own_colour;
#endif
void main() {
#ifdef LOOKS
    p_B = position;
    n_B = normal;
    own_colour = own;
#endif
    vec4 p = world_from_model * vec4(position, 1);
    p_W = p.xyz;
    n_W = mat3(world_from_model) * normal;
    gl_Position = clip_from_world * p;
}
)";

const char* const kSurfaceFragment = R"(
in vec3 p_W;
in vec3 n_W;
out vec4 colour;

uniform vec3 eye;
uniform vec3 albedo;
uniform float alpha;       // where one looks straight at the surface
uniform float rim;         // what is added to it where one looks along the surface
uniform float gloss;       // gloss of the surface's coat, 0 to 1
uniform float grid;        // how dark the lines on its upper side are
uniform float fade;        // beyond this distance from the middle it is the background; 0: never [m]
uniform vec3 middle;
uniform bool shadowed;
uniform vec3 light;        // toward it
uniform mat4 light_from_world;
uniform sampler2D moments;
uniform float texel;       // size of a texel of the map's finest level [m]

#ifdef LOOKS
in vec3 p_B;
in vec3 n_B;
in vec3 own_colour;
uniform bool metal;
uniform bool coloured;      // by the model's own colours
uniform bool pictured;
uniform vec2 picture_size;  // [m]
uniform sampler2D picture;

// The picture's colour where it is projected along the axis that the surface looks along most. The
// surface is continuous where the axis changes, and with it the derivatives that choose the level.
vec3 from_picture() {
    vec3 a = abs(n_B);
    vec3 right = vec3(0, n_B.x < 0.0 ? -1 : 1, 0);
    vec3 up = vec3(0, 0, 1);
    if (a.z >= max(a.x, a.y)) {
        right = vec3(1, 0, 0);
        up = vec3(0, n_B.z < 0.0 ? -1 : 1, 0);
    } else if (a.y >= a.x) {
        right = vec3(n_B.y < 0.0 ? 1 : -1, 0, 0);
    }
    mat2x3 axes = mat2x3(right / picture_size.x, -up / picture_size.y);  // rows go down
    return textureGrad(picture, 0.5 + p_B * axes, dFdx(p_B) * axes, dFdy(p_B) * axes).rgb;
}

// The mirrored surroundings of a metal in the direction r: brighter above the horizon than
// further up, where windows are, and on the lamp's side; on average equal to the light on other
// surfaces.
vec3 room(vec3 r, vec3 ground, vec3 sky) {
    float up = 1.7 - 1.4 * smoothstep(0.1, 0.9, r.z);
    float side = dot(r.xy, normalize(light.xy));
    return mix(ground, sky * up, smoothstep(-0.25, 0.25, r.z)) *
           (0.7 + 0.6 * smoothstep(-0.9, 0.9, side));
}

const float kPolish = 60.0;  // exponent of a metal's highlight

// A metal has no diffuse light. Its colour is the share reflected at normal incidence; Schlick's
// law gives the rest.
vec3 reflectance(vec3 straight, float cosine) {
    return straight + (1.0 - straight) * pow(1.0 - max(cosine, 0.0), 5.0);
}
#endif

const float kLeast = 1.0e-7;     // variance [m^2]: a third of a millimetre
const float kBleeding = 0.35;    // light darker than this is drawn black
const float kLightSize = 0.10;   // standard deviation of the penumbra over the height
const float kSearch = 0.015;     // standard deviation of the search for an occluder [m]

float chebyshev(vec2 m, float t) {
    float above = t - m.x;
    if (above <= 0.0) return 1.0;
    float variance = max(m.y - m.x * m.x, kLeast);
    return variance / (variance + above * above);
}

float level(float sigma) { return log2(max(sigma / (1.2 * texel), 1.0)); }

// x: share of the main light; y: of the light from around
vec2 visibility(vec3 n) {
    // off the surface by the resolution of a texel
    vec3 q = (light_from_world * vec4(p_W + 1.5 * texel * n, 1)).xyz;
    vec2 uv = 0.5 * q.xy + 0.5;
    float t = q.z;
    float inside = 1.0 - smoothstep(0.9, 1.0, max(abs(q.x), abs(q.y)));
#ifdef PLAIN
    return mix(vec2(1), vec2(t <= textureLod(moments, uv, 0.0).x ? 1 : 0, 1), inside);
#else
    // height of the occluder above: the share `around` of the depths is taken to be t, the rest
    // the occluder's; where there is hardly any occluder, the estimate fades out
    vec2 wide = textureLod(moments, uv, round(level(kSearch))).rg;  // one level: half the work
    float around = chebyshev(wide, t);
    float above = (t - wide.x) / max(1.0 - around, 0.01) * smoothstep(0.0, 0.08, 1.0 - around);
    vec2 near = textureLod(moments, uv, level(kLightSize * max(above, 0.0))).rg;
    vec2 seen = max((vec2(chebyshev(near, t), around) - kBleeding) / (1.0 - kBleeding), 0.0);
    return mix(vec2(1), seen, inside);
#endif
}

float line(vec2 p, float spacing, float width) {
    vec2 blur = fwidth(p);
    vec2 d = abs(fract(p / spacing - 0.5) - 0.5) * spacing;
    vec2 cover = clamp((width + blur - d) / (2.0 * blur), 0.0, 1.0) * min(vec2(1), 2.0 * width / blur);
    return max(cover.x, cover.y);
}

void main() {
    vec3 n = normalize(n_W);
    vec3 v = normalize(eye - p_W);
    vec3 base = albedo;
#ifdef LOOKS
    if (coloured) base = own_colour;
    if (pictured) base = from_picture();
#endif
    if (grid > 0.0 && n.z > 0.99) {
        float drawn = max(0.55 * line(p_W.xy, 0.025, 0.00015),
                          line(p_W.xy, 0.1, 0.0003));
        base *= 1.0 - grid * drawn;
    }
    vec2 seen = shadowed ? visibility(n) : vec2(1);
    const vec3 sky = vec3(0.44, 0.47, 0.52);
    const vec3 ground = vec3(0.29, 0.275, 0.26);
    const vec3 key = vec3(0.88, 0.85, 0.80);
    vec3 around = mix(ground, sky, 0.5 + 0.5 * n.z) * mix(0.55, 1.0, seen.y);
    vec3 direct = key * max(dot(n, light), 0.0) * seen.x;
    // a clear coat: Schlick's reflectance of glass, Blinn's highlight, and the surroundings
    vec3 h = normalize(light + v);
    float fresnel = 0.04 + 0.96 * pow(1.0 - max(dot(n, v), 0.0), 5.0);
    vec3 r = reflect(-v, n);
    vec3 mirrored = mix(ground, sky, smoothstep(-0.3, 0.7, r.z)) * mix(0.4, 1.0, seen.y);
    vec3 coat = fresnel * 0.5 * mirrored;
    coat += key * 0.35 * pow(max(dot(n, h), 0.0), 70.0) * seen.x * step(0.0, dot(n, light));
    vec3 out_linear = base * (around + direct) + gloss * coat;
#ifdef LOOKS
    if (metal)
        out_linear = reflectance(base, dot(n, v)) * room(r, ground, sky) * mix(0.4, 1.0, seen.y) +
                     reflectance(base, dot(v, h)) * direct * (kPolish + 8.0) / 8.0 *
                         pow(max(dot(n, h), 0.0), kPolish);
#endif
    if (fade > 0.0)
        out_linear = mix(out_linear, background(), smoothstep(0.3 * fade, fade, length(p_W.xy - middle.xy)));
    float grazing = 1.0 - max(dot(n, v), 0.0);
    colour = vec4(encode(out_linear), alpha + rim * grazing * grazing);
}
)";

}  // namespace dihaptic::view::shaders
