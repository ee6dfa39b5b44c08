// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlineScriptOnly.h" // the interface of Qt's meta-objects needs a source
