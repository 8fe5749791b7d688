#version 460
// Pass `mesh`: writes the visible triangle.
layout(location = 0) flat in uvec2 seen;
layout(location = 0) out uvec2 visible;

void main() {
    visible = seen;
}
