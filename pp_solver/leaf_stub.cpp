#include "pp_solver/leaf_scattering.hpp"
namespace sunfleck::pp {
LeafAngles LeafAngles::spherical(){return {};}
double leafProjection(const LeafAngles&, double){return .5;}
}
