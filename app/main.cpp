#include "commands.h"
int main() { return 0; }
