#version 460
// Pass 2: the geometry-aware filter over one period of the interleaved pattern (spec §7), accumulation over frames (spec
// §12), then composition (spec §4).
// Twin of ambray_core::filter. A workgroup keeps its tile with a border in shared memory: first what decides whether
// neighbours are accepted, then one plane after the other.
#extension GL_GOOGLE_include_directive : require
#include "include/extensions.glsl"
#include "include/camera.glsl"
#include "include/compose.glsl"
#include "include/temporal.glsl"

layout(local_size_x = FILTER_WIDTH, local_size_y = FILTER_HEIGHT) in;

const uint TILE_WIDTH = FILTER_WIDTH + 2u * FILTER_REACH;
const uint TILE_HEIGHT = FILTER_HEIGHT + 2u * FILTER_REACH;
const uint TILE = TILE_WIDTH * TILE_HEIGHT;
const uint THREADS = FILTER_WIDTH * FILTER_HEIGHT;
const int REACH = int(FILTER_REACH);
const uint TAPS = 2u * FILTER_REACH + 1u;

// Position and depth, which is FAR where nothing is seen.
shared vec4 positions[TILE];
// Normal in the first pass over the tile, values of a plane later.
shared vec4 values[TILE];

uint tile_index(ivec2 offset) {
    uvec2 at = uvec2(ivec2(gl_LocalInvocationID.xy) + REACH + offset);
    return at.y * TILE_WIDTH + at.x;
}

// Index of the pixel behind entry `i` of the tile, NONE outside the picture.
uint pixel_of(uint i) {
    ivec2 origin = ivec2(push.origin + gl_WorkGroupID.xy * uvec2(FILTER_WIDTH, FILTER_HEIGHT)) - REACH;
    ivec2 pixel = origin + ivec2(i % TILE_WIDTH, i / TILE_WIDTH);
    ivec2 size = ivec2(VIEW.size);
    bool inside = all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size));
    return inside ? uint(pixel.y * size.x + pixel.x) : NONE;
}

void load_values(uint64_t plane) {
    for (uint i = gl_LocalInvocationIndex; i < TILE; i += THREADS) {
        uint pixel = pixel_of(i);
        values[i] = pixel == NONE ? vec4(0.0) : Plane(plane).at[pixel];
    }
}

void load_guides() {
    for (uint i = gl_LocalInvocationIndex; i < TILE; i += THREADS) {
        uint pixel = pixel_of(i);
        positions[i] = pixel == NONE ? vec4(0.0, 0.0, 0.0, FAR) : Plane(VIEW.positions).at[pixel];
    }
    load_values(VIEW.smooth_normals);
}

// Weight of an offset along one axis, 0 outside the window.
float axis_weight(int offset) {
    switch (WINDOW) {
        case WINDOW_OFF: return offset == 0 ? 1.0 : 0.0;
        case WINDOW_BOX: return offset >= -1 ? 1.0 : 0.0;
        default: return abs(offset) == 2 ? 0.5 : 1.0;
    }
}

// One bit a tap: whether it counts.
uint accepted_taps() {
    uint centre = tile_index(ivec2(0));
    vec4 p = positions[centre];
    vec3 normal = values[centre].xyz;
    float footprint = pixel_footprint(p.w);
    uint taps = 0u;
    for (int y = -REACH; y <= REACH; ++y) {
        for (int x = -REACH; x <= REACH; ++x) {
            uint q = tile_index(ivec2(x, y));
            bool in_window = axis_weight(x) * axis_weight(y) > 0.0;
            bool is_centre = x == 0 && y == 0;
            if (in_window && (is_centre || (positions[q].w < FAR && accepts(p, normal, footprint, positions[q], values[q].xyz)))) {
                taps |= 1u << (uint(y + REACH) * TAPS + uint(x + REACH));
            }
        }
    }
    return taps;
}

// Mean over the accepted taps of the plane in `values`.
vec4 filtered(uint taps) {
    vec4 sum = vec4(0.0);
    float weight = 0.0;
    for (int y = -REACH; y <= REACH; ++y) {
        for (int x = -REACH; x <= REACH; ++x) {
            if ((taps >> (uint(y + REACH) * TAPS + uint(x + REACH)) & 1u) != 0u) {
                float k = axis_weight(x) * axis_weight(y);
                weight += k;
                sum += k * values[tile_index(ivec2(x, y))];
            }
        }
    }
    return sum / weight;
}

vec4 filtered_plane(uint64_t plane, uint taps) {
    barrier();
    load_values(plane);
    barrier();
    return filtered(taps);
}

void main() {
    load_guides();
    barrier();
    vec4 guide = positions[tile_index(ivec2(0))];
    vec3 normal = values[tile_index(ivec2(0))].xyz;
    bool is_surface = guide.w < FAR;
    // Pixels that see nothing are copied.
    uint taps = is_surface ? accepted_taps() : 1u << (FILTER_REACH * TAPS + FILTER_REACH);
    vec4 ambient = filtered_plane(VIEW.ambient, taps);
    if (AFTER_FILTER != 0u) {
        ambient = smaller_batch(ambient, filtered_plane(VIEW.second, taps));
    }
    vec4 bent = filtered_plane(VIEW.bent, taps);

    uvec2 pixel = push.origin + gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, VIEW.size)) || any(greaterThanEqual(gl_GlobalInvocationID.xy, push.extent))) {
        return;
    }
    uint index = pixel.y * VIEW.size.x + pixel.x;
    if (TEMPORAL != 0u) {
        Mean mean = Mean(ambient, bent, 1.0);
        if (is_surface) {
            mean = accumulated(index, guide.xyz, normal, mean);
        }
        keep(index, guide, normal, mean);
        ambient = mean.ambient;
        bent = mean.bent;
    }
    ambient = finish(ambient, VIEW.gather.ambient);
    Plane(VIEW.filtered).at[index] = ambient;
    Plane(VIEW.filtered_bent).at[index] = vec4(bent.xyz, 0.0);
    vec3 picture = Plane(VIEW.emission).at[index].rgb;
    if (is_surface) {
        vec3 albedo = Plane(VIEW.albedo).at[index].rgb;
        vec3 direct = Plane(VIEW.direct).at[index].rgb;
        picture = compose(picture, albedo, VIEW.gather.ambient, ambient, direct);
    }
    Plane(VIEW.beauty).at[index] = vec4(picture, 1.0);
}
