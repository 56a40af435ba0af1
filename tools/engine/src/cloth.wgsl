// A checkered cloth, red to the left of the seam of its texture and blue to the right, lit from the eye's left.

@group(0) @binding(0) var<uniform> camera: mat4x4f;

struct Seen {
    @builtin(position) place: vec4f,
    @location(0) normal: vec3f,
    @location(1) texture: vec2f,
}

@vertex
fn seen(@location(0) place: vec3f, @location(1) normal: vec3f, @location(2) texture: vec2f) -> Seen {
    return Seen(camera * vec4f(place, 1.0), normal, texture);
}

@fragment
fn shaded(point: Seen, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let normal = normalize(select(-point.normal, point.normal, is_front));
    let light = 0.25 + 0.75 * max(dot(normal, normalize(vec3f(-0.5, 0.4, 0.8))), 0.0);
    let cell = floor(8.0 * point.texture);
    let tone = select(1.0, 0.75, (cell.x + cell.y) % 2.0 == 0.0);
    let color = select(vec3f(0.8, 0.25, 0.2), vec3f(0.25, 0.45, 0.8), point.texture.x > 1.0);
    return vec4f(light * tone * color, 1.0);
}
