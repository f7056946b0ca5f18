#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "grid/detail/density_cells.hpp"

namespace sunfleck {

void writeNanoVdb(const openvdb::GridCPtrVec& grids, const std::filesystem::path& file) {
  std::vector<nanovdb::GridHandle<>> handles;
  for (const auto& grid : grids)
    handles.push_back(nanovdb::openToNanoVDB<nanovdb::HostBuffer, openvdb::FloatTree>(
        *openvdb::gridConstPtrCast<openvdb::FloatGrid>(grid), nanovdb::StatsMode::All, nanovdb::ChecksumMode::Full));
  std::ofstream out(file, std::ios::binary);
  nanovdb::io::writeGrids<nanovdb::HostBuffer, std::vector>(out, handles);
  out.close();
  if (!out) throw std::runtime_error(std::strerror(errno));
}

}  // namespace sunfleck
