// The scene in tables, read through device addresses.
#ifndef SCENE_GLSL
#define SCENE_GLSL

#include "layout.glsl"

#define TABLE(Name, Element, Align) layout(buffer_reference, scalar, buffer_reference_align = Align) readonly buffer Name { Element at[]; }
TABLE(Placements, Placement, 4);
TABLE(Instances, Instance, 4);
TABLE(Meshes, Mesh, 4);
TABLE(Materials, Material, 4);
TABLE(Textures, Texture, 4);
TABLE(Levels, ImageLevel, 4);
TABLE(Lights, Light, 4);
TABLE(ShapeInstances, ShapeInstance, 4);
TABLE(FloatArray, float, 4);
TABLE(Uints, uint, 4);
TABLE(Uvec2s, uvec2, 8);
TABLE(Uvec3s, uvec3, 4);
TABLE(Vec2s, vec2, 8);
TABLE(Vec3s, vec3, 4);
TABLE(Vec4s, vec4, 16);
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Shapes { Shape at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer SceneReference { SceneTables data; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer ViewReference { View data; };

// Planes are written, too.
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Plane { vec4 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Tallies { Tally at[]; };

layout(push_constant, scalar) uniform PushBlock { Push push; };

#define SCENE SceneReference(push.scene).data
#define VIEW ViewReference(push.view).data

// The instance and the triangle (x, y) of a primitive that the structures report.
uvec2 resolve(uint custom_index, uint primitive) {
    Placement placement = Placements(SCENE.placements).at[custom_index];
    uvec2 reference = Uvec2s(SCENE.refs).at[placement.first_ref + primitive];
    return uvec2(placement.instance == NONE ? reference.x : placement.instance, reference.y);
}

bool is_shape(uint instance) {
    return SHAPES != 0u && instance >= SCENE.mesh_instances;
}

ShapeInstance shape_instance(uint instance) {
    return ShapeInstances(SCENE.shape_instances).at[instance - SCENE.mesh_instances];
}

// Whether animations move the instance of a hit, a MOTION constant.
uint motion_of(uint instance) {
    return is_shape(instance) ? shape_instance(instance).motion : Instances(SCENE.instances).at[instance].motion;
}

#endif
