#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "common/progress.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Remarks of a reader on a file that it accepted. */
struct MeshRemarks
{
  std::vector<std::string> notes;     ///< changes that the file itself asks for
  std::vector<std::string> warnings;  ///< oddities that the user should check, each with the name of the file
};

/** True if a comment or header of a file has 3D Slicer's `SPACE=RAS`: x points right and y forward there, against left
 *  and backward in the patient frame (LPS). */
bool namesRasSpace(std::string_view header);

/** Collects the vertices and polygons of a mesh file and makes a triangle mesh of them.
 *
 *  Vertices with bitwise equal coordinates become one, numbered in the order in which faces first use them. Polygons
 * are triangulated by ear clipping in the plane of their Newell normal. */
class MeshBuilder
{
public:
  /** Largest number of corners of a polygon. */
  static constexpr std::size_t kMaxCorners = 1024;

  /** @param path file, named in errors
   *  @param unit metres per unit of the file
   *  @param bytes of the file, for the progress */
  MeshBuilder(std::string path, double unit, std::size_t bytes = 1, ProgressReport progress = {})
    : path_(std::move(path)), unit_(unit), bytes_(static_cast<double>(bytes)), progress_(std::move(progress))
  {
  }

  /** Reports the progress of reading, from time to time.
   *  @param rest bytes of the file that are not read yet */
  void reportRest(std::size_t rest)
  {
    if (++reports_ % kRecordsPerReport == 0)
      reportProgress(progress_, "reading the mesh file", 1.0 - static_cast<double>(rest) / bytes_);
  }

  /** Adds a vertex of the file.
   *  @param position in units of the file
   *  @param line of the file that defines it; 0: unknown
   *  @throws InputError for a coordinate that is not finite */
  void addVertex(const Eigen::Vector3d& position, std::size_t line = 0);

  /** Adds a face by the numbers of its vertices, from 0; vertices may follow later. Faces of fewer than three corners
   * are ignored.
   *  @throws InputError for more than kMaxCorners corners */
  void addFace(const std::vector<long long>& corners, std::size_t line = 0);

  std::size_t vertices() const { return positions_.size(); }

  /** Takes note of the coordinate system that a header or a comment of the file names (namesRasSpace). */
  void readSpace(std::string_view header) { is_ras_ = is_ras_ || namesRasSpace(header); }

  void warn(const std::string& warning) { remarks_.warnings.push_back(path_ + ": " + warning); }
  const MeshRemarks& remarks() const { return remarks_; }

  /** Makes the mesh, in metres. Coordinates of the space RAS are turned to the patient frame, with a note.
   *  @throws InputError for a vertex number out of range, or a file without triangles */
  geometry::TriangleMesh build();

private:
  static constexpr std::size_t kRecordsPerReport = 20000;

  /** Range of corners_ of one face. */
  struct Face
  {
    std::size_t begin = 0;
    std::size_t end = 0;
    std::size_t line = 0;
  };

  [[noreturn]] void refuse(const char* kind, std::size_t index, std::size_t line, const std::string& reason) const;
  void turnFromRas();
  void triangulate(std::size_t first, std::size_t last);
  int meshVertex(int vertex);
  void addTriangle(int a, int b, int c);

  std::string path_;
  double unit_;
  double bytes_;  ///< size of the file
  ProgressReport progress_;
  std::size_t reports_ = 0;
  std::vector<Eigen::Vector3d> positions_;  ///< vertices of the file [units of the file]
  std::vector<long long> corners_;          ///< vertex numbers of all faces
  std::vector<Face> faces_;
  bool is_ras_ = false;  ///< true if the file names the space RAS
  MeshRemarks remarks_;
  std::vector<int> ring_;                             ///< remaining corners of the polygon being triangulated
  std::vector<int> mesh_vertex_;                      ///< number in the mesh of every vertex of the file; −1: unused
  std::map<std::array<double, 3>, int> by_position_;  ///< mesh vertices by their coordinates [units of the file]
  geometry::TriangleMesh mesh_;
};

}  // namespace endovascular_sim::vessel
