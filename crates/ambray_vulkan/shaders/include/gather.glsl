// The estimator: N rays from a point, then openness O and near-field radiance I (spec §§3, 5, 8). Twin of
// ambray_core::gather. The including file says how rays are traced and surfaces are shaded.
#ifndef GATHER_GLSL
#define GATHER_GLSL

#include "basis.glsl"
#include "direct.glsl"
#include "openness.glsl"

struct ShadedPoint {
    vec3 position;
    vec3 geometric_normal;
    float reach;
    // Directions are sampled about it.
    vec3 normal;
    uint sample_set;
    uint hash;
    uint instance;
};

// Openness with its near radiance of each batch, and the mean open direction.
struct Gathered {
    vec4 first;
    vec4 second;
    vec4 both;
    vec3 bent;
    // Share of 1 - O of the first batch due to what may move against the point; 0 unless light is accumulated.
    float changing;
    Tally tally;
};

// Sums over the first batch. Directions are added in blocks of 64: single precision then keeps 65536 of them apart.
struct Sums {
    float open;
    float changing;
    vec3 bent;
    vec3 per_hit;
    float weight;
    vec3 weighted;
};

const Sums NO_SUMS = Sums(0.0, 0.0, vec3(0.0), vec3(0.0), 0.0, vec3(0.0));

Sums add(Sums a, Sums b) {
    return Sums(
        a.open + b.open, a.changing + b.changing, a.bent + b.bent, a.per_hit + b.per_hit, a.weight + b.weight,
        a.weighted + b.weighted);
}

// Sums over the chords of the second batch.
struct ChordSums {
    float blocked;
    float total;
    float weight;
    vec3 weighted;
};

// Whether a hit on the instance `occluder` may move against a point on the instance `receiver`.
bool may_change(uint receiver, uint occluder) {
    uint motion = motion_of(occluder);
    if (receiver == occluder) {
        return motion == MOTION_DEFORMING;
    }
    return motion != MOTION_STATIC || motion_of(receiver) != MOTION_STATIC;
}

float measure(float d) {
    return openness_at(d, VIEW.gather.radius, VIEW.gather.reach, VIEW.gather.exponent, VIEW.gather.sigma);
}

// Radiance L_r that leaves a hit (spec §3), and the geometric normal there. The factor of the self-similar bounce needs
// the final openness: see compose.glsl.
vec3 hit_radiance(Ray ray, Hit hit, float width, inout Tally tally, out vec3 geometric_normal) {
    At at = at_hit(ray.origin, ray.direction, hit, width);
    geometric_normal = towards(at.geometric_normal, -ray.direction);
    vec3 albedo = shade_surface(at, hit, 0u).albedo;
    switch (SOURCE) {
        case SOURCE_ALBEDO:
        case SOURCE_SELF_SIMILAR: return albedo;
        case SOURCE_AMBIENT: return albedo * VIEW.gather.ambient;
        default: {
            Receiver receiver = Receiver(at.position, geometric_normal, geometric_normal, at.reach, pcg(ray.seed));
            vec3 irradiance = direct_irradiance(receiver, SOURCE == SOURCE_LIT, tally.shadow_rays);
            return albedo * VIEW.gather.ambient + reflected(albedo, irradiance);
        }
    }
}

#include "thin.glsl"

// World direction of a sample, and its azimuth in w.
vec4 world_direction(ShadedPoint point, mat3 basis, uint j) {
    vec4 local = sample_direction(point.sample_set, point.hash, j);
    return vec4(basis[0] * local.x + basis[1] * local.y + basis[2] * local.z, local.w);
}

vec3 mean(vec3 weighted, float weight) {
    return weight > 0.0 ? weighted / weight : vec3(0.0);
}

// Openness o with the near radiance that is consistent with it (spec §8.1).
vec4 with_near(float o, float first, vec3 per_hit, Sums sums, ChordSums chords) {
    switch (NEAR_RADIANCE) {
        case NEAR_OFF: return vec4(o, vec3(0.0));
        case NEAR_PER_HIT:
            return vec4(o, first < 1.0
                ? per_hit * ((1.0 - o) / (1.0 - first))
                : mean(chords.weighted, chords.weight) * (1.0 - o));
        default:
            return vec4(o, mean(sums.weighted + chords.weighted, sums.weight + chords.weight) * (1.0 - o));
    }
}

Gathered gather(ShadedPoint point) {
    Gathered gathered;
    gathered.tally = Tally(0u, 0u, 0u, 0u, 0u, 0u);
    mat3 basis = basis_from_normal(point.normal);
    vec3 origin = ray_origin(point.position, point.geometric_normal, point.reach);
    clear_missed();
    Sums sums = NO_SUMS;
    Sums block = NO_SUMS;
    for (uint j = 0u; j < SPP; ++j) {
        vec3 direction = world_direction(point, basis, j).xyz;
        float d = FAR;
        vec3 radiance = vec3(0.0);
        bool changing = false;
        // A direction below the geometric horizon is blocked at once, without a ray (spec §5).
        if (dot(direction, point.geometric_normal) > 0.0) {
            Ray ray = Ray(origin, VIEW.gather.reach, direction, ray_seed(point.hash, j));
            Hit hit = trace_closest(RAY_AMBIENT, ray);
            gathered.tally.ambient_rays += 1u;
            if (hit.instance != NONE) {
                gathered.tally.ambient_hits += 1u;
                d = hit.t;
                changing = TEMPORAL != 0u && may_change(point.instance, hit.instance);
                if (NEAR_RADIANCE != NEAR_OFF) {
                    vec3 normal;
                    radiance = hit_radiance(ray, hit, hit.t * VIEW.gather.cone_width, gathered.tally, normal);
                }
            }
        } else {
            d = 0.0;
        }
        if (THIN != THIN_OFF && d >= VIEW.gather.radius) {
            set_missed(j);
        }
        float mu = measure(d);
        block.open += mu;
        block.changing += changing ? 1.0 - mu : 0.0;
        block.bent += mu * direction;
        block.per_hit += (1.0 - mu) * radiance;
        if (d < VIEW.gather.near_limit) {
            float w = NEAR_RADIANCE == NEAR_AVERAGED_PLAIN ? 1.0 : 1.0 - mu;
            block.weight += w;
            block.weighted += w * radiance;
        }
        if ((j & 63u) == 63u) {
            sums = add(sums, block);
            block = NO_SUMS;
        }
    }
    sums = add(sums, block);

    ChordSums chords = ChordSums(0.0, 0.0, 0.0, vec3(0.0));
    if (THIN != THIN_OFF) {
        chords = trace_chords(point, basis, gathered.tally);
    }
    float count = float(SPP);
    float first = sums.open / count;
    float second = chords.total > 0.0 ? 1.0 - chords.blocked / chords.total : 1.0;
    vec3 per_hit = sums.per_hit / count;
    gathered.first = with_near(first, first, per_hit, sums, chords);
    gathered.second = with_near(second, first, per_hit, sums, chords);
    gathered.both = with_near(min(first, second), first, per_hit, sums, chords);
    gathered.bent = sums.bent / count;
    gathered.changing = sums.changing / count;
    return gathered;
}

#endif
