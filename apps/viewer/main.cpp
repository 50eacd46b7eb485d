#include "viewer_program.hpp"

int main(int argc, char** argv) { return shape3d::apps::viewer::run_viewer(argc, argv); }
