#include "program.hpp"

int main(int argc, char** argv) { return knead::cli::program(argc, argv); }
