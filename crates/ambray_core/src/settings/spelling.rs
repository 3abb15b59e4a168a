//! Names of settings and alternatives, made from the names in the code when the program is compiled.

/// Letters of the kebab-case spelling of `name`.
pub(super) const fn kebab_length(name: &str) -> usize {
    let name = name.as_bytes();
    let (mut length, mut i) = (name.len(), 1);
    while i < name.len() {
        if name[i].is_ascii_uppercase() {
            length += 1;
        }
        i += 1;
    }
    length
}

/// The kebab-case spelling of `name`: `filter_plane` is `filter-plane`, `PerHit` is `per-hit`.
pub(super) const fn to_kebab<const LENGTH: usize>(name: &str) -> [u8; LENGTH] {
    let name = name.as_bytes();
    let mut spelled = [b'-'; LENGTH];
    let (mut i, mut at) = (0, 0);
    while i < name.len() {
        if i > 0 && name[i].is_ascii_uppercase() {
            at += 1; // the dash is there
        }
        if name[i] != b'_' {
            spelled[at] = name[i].to_ascii_lowercase();
        }
        (i, at) = (i + 1, at + 1);
    }
    spelled
}

/// An identifier in kebab case, as serde and clap spell it, as a constant string.
macro_rules! kebab {
    ($name:ident) => {{
        const NAME: &str = stringify!($name);
        const SPELLED: [u8; $crate::settings::spelling::kebab_length(NAME)] =
            $crate::settings::spelling::to_kebab(NAME);
        const TEXT: &str = match std::str::from_utf8(&SPELLED) {
            Ok(text) => text,
            Err(_) => panic!("names are ASCII"),
        };
        TEXT
    }};
}
pub(super) use kebab;

#[cfg(test)]
mod tests {
    #[test]
    fn names_are_in_kebab_case() {
        assert_eq!([kebab!(spp), kebab!(filter_cos_normal)], ["spp", "filter-cos-normal"]);
        assert_eq!([kebab!(Off), kebab!(PerHit), kebab!(R2)], ["off", "per-hit", "r2"]);
    }
}
