#include "plastic/eigenstrain_displacement.h"

#include <gtest/gtest.h>
