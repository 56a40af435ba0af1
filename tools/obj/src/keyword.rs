//! The keywords of the OBJ format, as far as statements are told apart by them.

/// What kind of statement a keyword begins, apart from `v`, `vt`, `vn`, and `f` or `fo`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Class {
    /// Structure that a cut leaves in place: nothing to warn of.
    Structure,
    /// Lines and points, which a cut does not divide.
    Element,
    /// In the format, and not interpreted here: free-form geometry, display attributes.
    Uninterpreted,
    /// Not in the format, such as the `nl`, `ny`, `nv`, `vv` of `ARCSim`, which say more about the
    /// element before them.
    Foreign,
}

impl Class {
    pub(crate) fn of(keyword: &[u8]) -> Class {
        match keyword {
            b"o" | b"g" | b"s" | b"usemtl" | b"mtllib" | b"mg" => Class::Structure,
            b"l" | b"p" => Class::Element,
            b"vp" | b"cstype" | b"deg" | b"bmat" | b"step" | b"curv" | b"curv2" | b"surf"
            | b"parm" | b"trim" | b"hole" | b"scrv" | b"sp" | b"end" | b"con" | b"bevel"
            | b"c_interp" | b"d_interp" | b"lod" | b"maplib" | b"usemap" | b"shadow_obj"
            | b"trace_obj" | b"ctech" | b"stech" | b"call" | b"csh" => Class::Uninterpreted,
            _ => Class::Foreign,
        }
    }
}

/// Whether a foreign statement is about the last `v` before it, as `ARCSim` reads it: a label that pins
/// the vertex, its plastic embedding, its velocity. It names no vertex by a number.
pub(crate) fn is_said_of_vertex(keyword: &[u8]) -> bool {
    matches!(keyword, b"nl" | b"ny" | b"nv" | b"vv")
}

/// How many tokens come before the indices of an uninterpreted statement whose indices count
/// the vertices `v`; `None` if it has none.
pub(crate) fn tokens_before_indices(keyword: &[u8]) -> Option<usize> {
    match keyword {
        b"l" | b"p" => Some(0),
        b"curv" => Some(2),
        b"surf" => Some(4),
        _ => None,
    }
}

/// Whether a statement that is kept as text may name vertices, texture coordinates or normals by
/// their numbers.
pub(crate) fn may_have_indices(keyword: &[u8]) -> bool {
    match Class::of(keyword) {
        Class::Structure => false,
        Class::Element => true,
        Class::Uninterpreted => tokens_before_indices(keyword).is_some(),
        // An empty one is that of a comment.
        Class::Foreign => !keyword.is_empty() && !is_said_of_vertex(keyword),
    }
}
