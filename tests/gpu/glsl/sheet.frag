#version 460
layout(binding = 0) readonly buffer Label { uint label; };
layout(location = 0) out uint face;
void main() {
    face = label;
}
