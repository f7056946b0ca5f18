#version 450 core
// (R24) What is seen in each pixel: the drawn tree and the triangle of its kind.
flat in uvec2 seen;
out uvec2 ids;

void main() { ids = seen; }
