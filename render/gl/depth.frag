#version 450 core
// Depth alone, so that afterwards each sample is shaded once.
void main() {}
