#include "boxwood/io/load.h"
namespace boxwood::io {
}
