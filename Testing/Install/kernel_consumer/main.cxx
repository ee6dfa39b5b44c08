#include "tautline/Core/Version.h"

#include <iostream>

int main()
{
  std::cout << "Tautline kernel " << tautline::version() << "\n";
  return 0;
}
