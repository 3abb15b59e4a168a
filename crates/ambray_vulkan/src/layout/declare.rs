//! Macros that declare something for Rust and for GLSL at once.

/// A Rust type that has a GLSL twin of the same scalar layout.
pub(super) trait Glsl {
    const NAME: &'static str;
}

macro_rules! twins {
    ($($rust:ty = $glsl:literal),* $(,)?) => { $( impl Glsl for $rust { const NAME: &'static str = $glsl; } )* };
}

twins! {
    f32 = "float",
    u32 = "uint",
    u64 = "uint64_t",
    [f32; 2] = "vec2",
    [f32; 3] = "vec3",
    [f32; 4] = "vec4",
    [u32; 2] = "uvec2",
    [u32; 3] = "uvec3",
    [u32; 4] = "uvec4",
    // Columns.
    [[f32; 2]; 3] = "mat3x2",
    [[f32; 3]; 3] = "mat3",
    [[f32; 3]; 4] = "mat4x3",
}

/// Structures with the layout of C in Rust and the scalar layout in GLSL. The module's `glsl` writes them in this order.
macro_rules! structures {
    ($( $(#[$meta:meta])* $name:ident { $( $(#[$field_meta:meta])* $field:ident: $type:ty, )* } )*) => {
        $(
            $(#[$meta])*
            #[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
            #[repr(C)]
            pub struct $name { $( $(#[$field_meta])* pub $field: $type, )* }

            impl $crate::layout::declare::Glsl for $name {
                const NAME: &'static str = stringify!($name);
            }
        )*

        pub(super) fn glsl(text: &mut String) {
            use $crate::layout::declare::Glsl;
            $(
                text.push_str(concat!("\nstruct ", stringify!($name), " {\n"));
                $(
                    text.push_str("    ");
                    text.push_str(<$type as Glsl>::NAME);
                    text.push_str(concat!(" ", stringify!($field), ";\n"));
                )*
                text.push_str("};\n");
            )*
        }
    };
}

/// Constants of both languages. Values are plain literals.
macro_rules! constants {
    ($( $(#[$meta:meta])* $name:ident: $type:ident = $value:literal; )*) => {
        $( $(#[$meta])* #[allow(missing_docs, reason = "runs of constants share the line above the first")]
           pub const $name: $type = $value; )*

        const CONSTANTS_GLSL: &str = concat!($( $crate::layout::declare::constant!($name $type $value), )*);
    };
}

macro_rules! constant {
    ($name:ident u32 $value:literal) => {
        concat!("const uint ", stringify!($name), " = ", stringify!($value), "u;\n")
    };
    ($name:ident f32 $value:literal) => {
        concat!("const float ", stringify!($name), " = ", stringify!($value), ";\n")
    };
}

pub(super) use constant;
pub(super) use constants;
pub(super) use structures;
