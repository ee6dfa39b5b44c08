#include "ShapeMatch.h"
