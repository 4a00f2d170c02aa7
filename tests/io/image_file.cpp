// Pictures on disk: what is written is read back, and a failed write leaves nothing.
#include "image_format_tests.hpp"
#include "image_refusal_tests.hpp"
#include "picture_decoding_tests.hpp"
#include "similarity_tests.hpp"
