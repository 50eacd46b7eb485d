#include "program.hpp"

int main(int argc, char** argv) { return shape3d::apps::run_program(argc, argv); }
