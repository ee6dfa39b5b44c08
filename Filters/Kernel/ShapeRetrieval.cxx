#include "ShapeRetrieval.h"
