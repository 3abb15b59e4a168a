// Made by `cargo xtask shaders` from src/layout.rs. Do not edit.
#ifndef LAYOUT_GLSL
#define LAYOUT_GLSL

const uint NONE = 4294967295u;
const float FAR = 3.4028235e38;
const uint RAY_PRIMARY = 0u;
const uint RAY_AMBIENT = 1u;
const uint RAY_CHORD = 2u;
const uint RAY_SHADOW = 3u;
const uint RAY_TYPES = 4u;
const uint GEOMETRY_OPAQUE = 0u;
const uint GEOMETRY_MASKED = 1u;
const uint GEOMETRY_SHAPE = 2u;
const uint GEOMETRY_KINDS = 3u;
const uint MATERIAL_LIT = 0u;
const uint MATERIAL_UNLIT = 1u;
const uint MATERIAL_EMISSIVE = 2u;
const uint MATERIAL_CHECKER = 3u;
const uint MATERIAL_KINDS = 4u;
const uint ALPHA_OPAQUE = 0u;
const uint ALPHA_MASK = 1u;
const uint ALPHA_BLEND = 2u;
const uint WRAP_REPEAT = 0u;
const uint WRAP_MIRROR = 1u;
const uint WRAP_CLAMP = 2u;
const uint TEXEL_NEAREST = 0u;
const uint TEXEL_LINEAR = 1u;
const uint SHAPE_SPHERE = 0u;
const uint SHAPE_BOX = 1u;
const uint SHAPE_CAPSULE = 2u;
const uint SHAPE_CYLINDER = 3u;
const uint SHAPE_FIELD = 4u;
const uint MOTION_STATIC = 0u;
const uint MOTION_RIGID = 1u;
const uint MOTION_DEFORMING = 2u;
const uint LIGHT_DIRECTIONAL = 0u;
const uint LIGHT_POINT = 1u;
const uint LIGHT_SPOT = 2u;
const uint NORMALS_SHADING = 0u;
const uint NORMALS_SMOOTH = 1u;
const uint NORMALS_GEOMETRIC = 2u;
const uint FALLOFF_POWER = 0u;
const uint FALLOFF_EXPONENTIAL = 1u;
const uint FALLOFF_EXPONENTIAL_TRUNCATED = 2u;
const uint FALLOFF_STEP = 3u;
const uint NEAR_AVERAGED = 0u;
const uint NEAR_AVERAGED_PLAIN = 1u;
const uint NEAR_PER_HIT = 2u;
const uint NEAR_OFF = 3u;
const uint SOURCE_ALBEDO = 0u;
const uint SOURCE_AMBIENT = 1u;
const uint SOURCE_SELF_SIMILAR = 2u;
const uint SOURCE_LIT = 3u;
const uint SOURCE_LIT_UNSHADOWED = 4u;
const uint THIN_OFF = 0u;
const uint THIN_PAPER = 1u;
const uint THIN_SHEET = 2u;
const uint SAMPLING_INTERLEAVED = 0u;
const uint SAMPLING_SAME = 1u;
const uint SAMPLING_RANDOM = 2u;
const uint SAMPLING_INDEPENDENT = 3u;
const uint SEQUENCE_OWEN = 1u;
const uint SEQUENCE_R2 = 2u;
const uint WINDOW_OFF = 0u;
const uint WINDOW_BOX = 1u;
const uint WINDOW_CENTRED = 2u;
const uint TEST_PLANE = 0u;
const uint TEST_ABSOLUTE = 1u;
const uint TEST_RELATIVE = 2u;
const uint TEST_NONE = 3u;
const uint AOV_BEAUTY = 0u;
const uint AOV_OPENNESS = 1u;
const uint AOV_OPENNESS_RAW = 2u;
const uint AOV_NEAR_RADIANCE = 3u;
const uint AOV_NEAR_RADIANCE_RAW = 4u;
const uint AOV_DIRECT = 5u;
const uint AOV_ALBEDO = 6u;
const uint AOV_EMISSION = 7u;
const uint AOV_DEPTH = 8u;
const uint AOV_POSITION = 9u;
const uint AOV_GEOMETRIC_NORMAL = 10u;
const uint AOV_SHADING_NORMAL = 11u;
const uint AOV_BENT_NORMAL = 12u;
const uint AOV_MATERIAL = 13u;
const uint AOV_INSTANCE = 14u;
const uint AOV_SAMPLE_CLASS = 15u;
const uint AOV_RAY_COUNT = 16u;
const uint AOV_MOTION = 17u;
const uint AOV_HISTORY = 18u;
const uint TONE_NONE = 0u;
const uint TONE_NEUTRAL = 1u;
const float LEAST_MOTION = 1.1754944e-38;
const float LONGEST = 1048576.0;
const float MOVING = 16.0;
const float CHANGING = 2.0;
const float CHANGING_SHARE = 0.1;
const float CHANGED_LEAST = 0.15;
const float CHANGED_MOST = 0.6;
const float CHANGED_FLOOR = 0.02;
const uint FILTER_WIDTH = 16u;
const uint FILTER_HEIGHT = 8u;
const uint FILTER_REACH = 2u;
const uint QUERY_WIDTH = 8u;
const uint QUERY_HEIGHT = 4u;
const uint MOTION_WIDTH = 64u;
const uint REDUCE_WIDTH = 128u;
const uint BOX_WORDS = 6u;
const uint CLUSTER_WORDS = 7u;
const uint FUNCTION_INTEGERS = 0u;
const uint FUNCTION_PIXELS = 1u;
const uint FUNCTION_ALPHA = 2u;
const uint FUNCTION_SAMPLES = 3u;
const uint FUNCTION_BASIS = 4u;
const uint FUNCTION_OPENNESS = 5u;
const uint FUNCTION_OFFSET = 6u;
const uint FUNCTION_LIGHT = 7u;
const uint FUNCTION_CAMERA = 8u;
const uint FUNCTION_TEXTURE = 9u;
const uint FUNCTION_CHECKER = 10u;
const uint FUNCTION_SHAPE_RAY = 11u;
const uint FUNCTION_SHAPE_SURFACE = 12u;
const uint FUNCTION_FINISH = 13u;
const uint FUNCTION_COMPOSE = 14u;
const uint FUNCTION_PREVIOUS = 15u;
const uint FUNCTION_TONE_MAP = 16u;
const uint ARGUMENTS = 16u;
const uint VALUES = 8u;

layout(constant_id = 0) const uint SPP = 8u;
layout(constant_id = 1) const uint SAMPLING = 0u;
layout(constant_id = 2) const uint SEQUENCE = 1u;
layout(constant_id = 3) const uint FALLOFF = 0u;
layout(constant_id = 4) const uint NEAR_RADIANCE = 0u;
layout(constant_id = 5) const uint SOURCE = 1u;
layout(constant_id = 6) const uint THIN = 0u;
layout(constant_id = 7) const uint THIN_EDGE = 0u;
layout(constant_id = 8) const uint AFTER_FILTER = 0u;
layout(constant_id = 9) const uint NORMALS = 0u;
layout(constant_id = 10) const uint WINDOW = 2u;
layout(constant_id = 11) const uint TEST = 0u;
layout(constant_id = 12) const uint TEMPORAL = 0u;
layout(constant_id = 13) const uint MASKED = 1u;
layout(constant_id = 14) const uint SHAPES = 1u;

struct SceneTables {
    uint64_t placements;
    uint64_t refs;
    uint64_t instances;
    uint64_t meshes;
    uint64_t materials;
    uint64_t textures;
    uint64_t levels;
    uint64_t texels;
    uint64_t srgb;
    uint64_t positions;
    uint64_t normals;
    uint64_t tangents;
    uint64_t uvs;
    uint64_t colors;
    uint64_t triangles;
    uint64_t shapes;
    uint64_t shape_instances;
    uint64_t previous_instances;
    uint64_t previous_shape_instances;
    uint64_t previous_positions;
    uint64_t previous_normals;
    uint mesh_instances;
    uint padding;
};

struct Placement {
    uint first_ref;
    uint instance;
};

struct Instance {
    mat4x3 world_from_object;
    mat3 normal_from_object;
    float side;
    uint mesh;
    uint motion;
};

struct Mesh {
    uint first_triangle;
    uint first_vertex;
    uint vertices;
    uint first_normal;
    uint first_tangent;
    uint first_color;
    uint first_uv;
    uint uv_sets;
    uint material;
    uint previous_vertex;
    uint previous_normal;
};

struct TextureUse {
    mat3x2 transform;
    uint texture;
    uint uv_set;
};

struct Material {
    vec4 base_color;
    vec3 emission;
    uint kind;
    vec3 checker_color;
    float checker_size;
    uint alpha_mode;
    float alpha_cutoff;
    float normal_scale;
    TextureUse base_color_texture;
    TextureUse normal_texture;
    TextureUse emission_texture;
};

struct Texture {
    uint first_level;
    uint level_count;
    uvec2 wrap;
    uint mag;
    uint min;
    uint mip;
    uint srgb;
};

struct ImageLevel {
    uvec2 size;
    uint first_texel;
};

struct Shape {
    uint kind;
    float a;
    float b;
    float c;
    uint64_t field;
    uvec3 grid;
    vec3 box_min;
    vec3 box_max;
    uint padding;
};

struct ShapeInstance {
    mat4x3 world_from_object;
    mat4x3 object_from_world;
    mat3 normal_from_object;
    float reach;
    uint shape;
    uint material;
    uint motion;
};

struct Light {
    uint kind;
    vec3 place;
    vec3 strength;
    float range;
    vec3 axis;
    float cos_inner;
    float cos_outer;
};

struct Deformation {
    uint64_t rest_positions;
    uint64_t rest_normals;
    uint64_t rest_tangents;
    uint64_t targets;
    uint64_t influences;
    uint64_t joints;
    uint64_t positions;
    uint64_t normals;
    uint64_t tangents;
    uint64_t bounds;
    uint vertices;
    uint target_count;
    uint influences_per_vertex;
    uint padding;
};

struct Target {
    uint64_t positions;
    uint64_t normals;
    uint64_t tangents;
    float weight;
    uint padding;
};

struct Influence {
    uint joint;
    float weight;
};

struct Clusters {
    uint64_t positions;
    uint64_t triangles;
    uint64_t clusters;
    uint64_t boxes;
    uint64_t bounds;
    uint64_t cost;
    uint triangle_count;
    uint side;
};

struct GatherConstants {
    uint64_t directions;
    uint64_t by_azimuth;
    uint64_t lights;
    uint light_count;
    float radius;
    float reach;
    float exponent;
    float sigma;
    float near_limit;
    vec3 ambient;
    float offset_near_zero;
    float offset_distance;
    float cone_width;
};

struct FilterConstants {
    float tolerance;
    float cos_normal;
};

struct MeanPlanes {
    uint64_t positions;
    uint64_t normals;
    uint64_t ambient;
    uint64_t bent;
    uint64_t frames;
};

struct TemporalConstants {
    MeanPlanes earlier;
    MeanPlanes next;
    uint64_t then_positions;
    uint64_t then_normals;
    vec3 eye;
    vec3 forward;
    vec3 right;
    vec3 up;
    float half_height;
    uint orthographic;
    uint has_earlier;
    uint scene_moved;
    uint camera_moved;
    float tolerance;
};

struct View {
    GatherConstants gather;
    uint64_t positions;
    uint64_t geometric;
    uint64_t shading;
    uint64_t smooth_normals;
    uint64_t albedo;
    uint64_t emission;
    uint64_t direct;
    uint64_t ambient;
    uint64_t second;
    uint64_t bent;
    uint64_t tallies;
    uint64_t filtered;
    uint64_t filtered_bent;
    uint64_t beauty;
    uint64_t inputs;
    uint64_t outputs;
    TemporalConstants temporal;
    FilterConstants filter_by;
    vec3 eye;
    vec3 forward;
    vec3 right;
    vec3 up;
    float half_height;
    uint orthographic;
    uvec2 size;
    uint count;
    uint mode;
    uint frame;
    uint seed;
    vec3 background;
    uint padding;
};

struct Tally {
    uint ambient_rays;
    uint ambient_hits;
    uint chord_rays;
    uint chord_hits;
    uint direct_shadow_rays;
    uint shadow_rays;
};

struct Ray {
    vec3 origin;
    float t_max;
    vec3 direction;
    uint seed;
};

struct RayHit {
    float t;
    float u;
    float v;
    uint instance;
    uint triangle;
};

struct Push {
    uint64_t scene;
    uint64_t view;
    uvec2 origin;
    uvec2 extent;
};

struct Display {
    uint64_t ramp;
    uint64_t bounds;
    uint plane;
    uint tone_map;
    float brightness;
    uint has_range;
    vec2 range;
};

#endif
