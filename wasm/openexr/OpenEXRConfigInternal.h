#pragma once
#define OPENEXR_USE_INTERNAL_DEFLATE 1
