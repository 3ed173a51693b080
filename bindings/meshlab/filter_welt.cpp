// SPDX-License-Identifier: GPL-3.0-or-later
// The filters: what they are called, what can be set, what they do.
#include "filter_welt.hpp"
#include "marks.hpp"
#include "plugin.hpp"
#include "polygons.hpp"

#include <vcg/complex/algorithms/update/color.h>

#include <QJsonDocument>
#include <QJsonObject>

#include <algorithm>
#include <cmath>
#include <optional>

namespace {

// After the features.
enum Further { CustomRules, LimitSurface, Deviation, OpenControlMesh, HowManyFurther };

QJsonArray array_of(welt::Report const& report) {
    return QJsonDocument::fromJson(QByteArray(report.json().data(), int(report.json().size()))).array();
}

QJsonObject object_of(welt::Report const& report) {
    return QJsonDocument::fromJson(QByteArray(report.json().data(), int(report.json().size()))).object();
}

// Tells MeshLab how far a call is, and cancels it when MeshLab says so.
class Progress {
public:
    explicit Progress(vcg::CallBackPos* report)
        : job_([this, report](double progress, std::string_view stage) {
              int const percent = int(100 * progress);
              if (!report || (percent == percent_ && stage == stage_)) return;
              percent_ = percent;
              stage_ = stage;
              if (!report(percent, stage_.c_str())) job_.cancel();
          }) {}
    welt::Job const* job() const { return &job_; }

private:
    int percent_ = -1;
    std::string stage_;
    welt::Job job_;
};

// What went wrong, and the first of the places it went wrong at.
std::runtime_error explained(welt::Error const& error) {
    constexpr std::size_t most = 5;
    std::string message = error.what();
    for (std::size_t i = 0; i < std::min(most, error.places().size()); ++i) {
        welt::Place const& place = error.places()[i];
        std::string at;
        if (place.line > 0) at = place.file + ":" + std::to_string(place.line) + ":" + std::to_string(place.column) + ": ";
        if (at.empty() && place.message == error.what()) continue;
        message += "\n  " + at + place.message;
    }
    if (error.places().size() > most) message += "\n  and " + std::to_string(error.places().size() - most) + " more";
    if (error.code() == WELT_ERROR_MESH)
        message += "\nFaces are polygons here, counted from 0. Filters, Cleaning and Repairing mends them, for example 'Repair non "
                   "Manifold Edges by removing faces' and 'Re-Orient all faces coherently'.";
    return std::runtime_error(message);
}

welt::Mesh mesh_of(PolygonMesh const& polygons, RichParameterList const& parameters) {
    welt::Mesh mesh(polygons.sizes, polygons.vertices, polygons.positions);
    static constexpr std::uint32_t boundaries[] = {WELT_BOUNDARY_EDGE_ONLY, WELT_BOUNDARY_EDGE_AND_CORNER, WELT_BOUNDARY_NONE};
    int const boundary = parameters.getEnum("boundary");
    if (boundary < 0 || boundary > 2) throw std::runtime_error("boundary is 0, 1 or 2");
    mesh.set_subdivision(boundaries[boundary], WELT_CREASING_UNIFORM);
    return mesh;
}

// What of the report a user looks for.
std::string summary(welt::Mesh const& mesh, std::size_t marks, welt::Report const& report) {
    QJsonObject const all = object_of(report);
    QString text = QString("%1 edges marked; the mesh now has %2 vertices and %3 polygons")
                       .arg(marks)
                       .arg(mesh.vertex_count())
                       .arg(mesh.face_count());
    for (QJsonValue const feature : all["features"].toArray())
        for (QJsonValue const dimension : feature.toObject()["dimensions"].toArray()) {
            QJsonObject const values = dimension.toObject();
            text += QString("\n%1: reached %2 of %3 in the mean")
                        .arg(values["name"].toString())
                        .arg(values["reached_mean"].toDouble())
                        .arg(values["asked_mean"].toDouble());
        }
    for (QJsonValue const value : all["warnings"].toArray()) {
        QJsonObject const warning = value.toObject();
        if (warning["kind"].toString() == "fold")
            text += QString("\nwarning: the limit surface folds at %1 vertices; ask for less depth or more width")
                        .arg(warning["vertices"].toArray().size());
        else if (warning["kind"].toString() == "wall")
            text += QString("\nwarning: a depth of %1 exceeds the wall, which is %2 thick; ask for less depth")
                        .arg(warning["depth"].toDouble())
                        .arg(warning["thickness"].toDouble());
    }
    int const leftovers = all["leftovers"].toArray().size();
    if (leftovers > 0) text += QString("\nwarning: no rule handles the marks of %1 polygons; set strict to see which").arg(leftovers);
    return text.toStdString();
}

struct Dense {
    std::vector<welt::Vector> positions;
    std::vector<std::uint32_t> sizes, vertices;
};

// The surface refined `level` times, every vertex moved to its limit.
Dense limit_of(welt::Mesh const& mesh, RichParameterList const& parameters, welt::Job const* job) {
    int const level = parameters.getInt("level");
    if (level < 0) throw std::runtime_error("level is 0 or more");
    if (level == 0) {
        welt::Mesh::Faces faces = mesh.faces();
        return {mesh.limit_positions(), std::move(faces.sizes), std::move(faces.vertices)};
    }
    auto const depth = std::uint32_t(level);
    welt::Refinement const refinement = mesh.refine(depth, job);
    auto const vertices = refinement.face_vertices(depth);
    PolygonMesh polygons;
    polygons.sizes.assign(refinement.face_count(depth), 4);
    polygons.vertices.assign(vertices.begin(), vertices.end());
    polygons.positions.assign(refinement.positions(depth).begin(), refinement.positions(depth).end());
    return {mesh_of(polygons, parameters).limit_positions(), std::move(polygons.sizes), std::move(polygons.vertices)};
}

std::string apply_feature(QString const& feature, QJsonArray const& settable, RichParameterList const& parameters,
                          MeshModel& layer, welt::Job const* job) {
    PolygonMesh const polygons = polygons_of(layer.cm);
    welt::Mesh mesh = mesh_of(polygons, parameters);
    welt::Selection const marks = marks_of(mesh, polygons, parameters);
    welt::FeatureOptions options;
    options.fit = std::uint32_t(parameters.getEnum("fit"));
    options.parity = std::uint32_t(parameters.getEnum("parity"));
    options.strict = parameters.getBool("strict");

    std::optional<welt::Report> report;
    if (feature.isEmpty()) {
        QString const file = parameters.getOpenFileName("rules");
        if (file.isEmpty()) throw std::runtime_error("no rule file is named: choose a .rules file with the button");
        report = mesh.apply(marks, welt::Rules::load(file.toStdString()), parameters.getString("settings").toStdString(),
                            options, job);
    } else {
        QString settings;
        for (QJsonValue const entry : settable) {
            QString const name = entry.toObject()["name"].toString();
            QString const value = entry.toObject()["unit"] == "count" ? QString::number(parameters.getInt(name))
                                                                     : parameters.getString(name).trimmed();
            if (!value.isEmpty()) settings += " " + name + "=" + value;
        }
        report = mesh.apply(marks, feature.toStdString(), settings.toStdString(), options, job);
    }

    // The file first: where it cannot be written the layer stays as it is.
    QString const file = parameters.getSaveFileName("polygons");
    if (!file.isEmpty()) mesh.export_file(file.toStdString());
    bool const more = layer.hasDataMask(MeshModel::MM_WEDGTEXCOORD) || layer.hasDataMask(MeshModel::MM_FACECOLOR) ||
                      layer.hasDataMask(MeshModel::MM_FACEQUALITY);
    welt::Mesh::Faces const faces = mesh.faces();
    write_back(layer, mesh.positions(), faces.sizes, faces.vertices, true);
    return summary(mesh, marks.count(), *report) + (more ? "\ntexture coordinates, colour and quality of faces are gone" : "");
}

std::string make_limit_surface(RichParameterList const& parameters, MeshDocument& document, welt::Job const* job) {
    MeshModel& layer = *document.mm();
    Dense const dense = limit_of(mesh_of(polygons_of(layer.cm), parameters), parameters, job);
    auto const transform = layer.cm.Tr;
    MeshModel* made = document.addNewMesh("", "limit surface of " + layer.label(), true);
    write_back(*made, dense.positions, dense.sizes, dense.vertices, false);
    made->cm.Tr = transform;
    return "limit surface: " + std::to_string(dense.positions.size()) + " vertices in a new layer";
}

std::string open_control_mesh(RichParameterList const& parameters, MeshDocument& document) {
    QString const file = parameters.getOpenFileName("file");
    if (file.isEmpty()) throw std::runtime_error("no file is named: choose an OBJ or PLY file with the button");
    welt::Mesh const mesh = welt::Mesh::import_file(file.toStdString());
    welt::Mesh::Faces const faces = mesh.faces();
    MeshModel* made = document.addNewMesh("", QFileInfo(file).fileName(), true);
    write_back(*made, mesh.positions(), faces.sizes, faces.vertices, true);
    return std::to_string(mesh.vertex_count()) + " vertices, " + std::to_string(mesh.face_count()) + " polygons";
}

// The polygons of a layer where the document shows them.
PolygonMesh placed(MeshModel& layer) {
    PolygonMesh polygons = polygons_of(layer.cm);
    for (welt::Vector& p : polygons.positions) {
        welt::Vector moved;
        for (int i = 0; i < 3; ++i)
            moved[i] = layer.cm.Tr.ElementAt(i, 0) * p[0] + layer.cm.Tr.ElementAt(i, 1) * p[1] +
                       layer.cm.Tr.ElementAt(i, 2) * p[2] + layer.cm.Tr.ElementAt(i, 3);
        p = moved;
    }
    return polygons;
}

std::string measure_deviation(RichParameterList const& parameters, MeshDocument& document, welt::Job const* job) {
    MeshModel& layer = *document.mm();
    MeshModel* const other = layer_of(parameters, "reference", document);
    if (!other) throw std::runtime_error("there is no such layer: set reference to the layer that the surface is compared with");
    if (other == &layer) throw std::runtime_error("the layer is compared with itself: set reference to another layer");
    welt::Mesh const mesh = mesh_of(placed(layer), parameters);
    welt::Mesh const reference = mesh_of(placed(*other), parameters);
    Dense const dense = limit_of(mesh, parameters, nullptr);
    welt::Mesh::Deviation const both = mesh.deviation(reference, 8, job);
    std::vector<welt_surface_point> const closest = reference.freeze().closest(dense.positions);
    for (welt_surface_point const& point : closest)
        if (point.face == WELT_NONE)
            throw std::runtime_error("the reference has no limit surface: it has no faces, or boundary leaves all of them out");

    MeshModel* made = document.addNewMesh("", "deviation of " + layer.label(), true);
    write_back(*made, dense.positions, dense.sizes, dense.vertices, false);
    made->updateDataMask(MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR);
    float largest = 0;
    for (std::size_t i = 0; i < closest.size(); ++i) {
        double height = 0;
        for (int k = 0; k < 3; ++k) height += (dense.positions[i][k] - closest[i].position[k]) * closest[i].normal[k];
        float const quality = float(std::copysign(closest[i].distance, height));
        made->cm.vert[i].Q() = quality;
        largest = std::max(largest, std::abs(quality));
    }
    vcg::tri::UpdateColor<CMeshO>::PerVertexQualityRamp(made->cm, -largest, largest);
    return QString("deviation of the limit surfaces, both ways: max %1, rms %2, 95 % within %3; quality of the new layer: from "
                   "%4, inside of the reference, to %5")
        .arg(both.largest)
        .arg(both.root_mean_square)
        .arg(both.percentile_95)
        .arg(-largest)
        .arg(largest)
        .toStdString();
}

void add_boundary(RichParameterList& list) {
    list.addParam(RichEnum("boundary", 0, QStringList{"curve", "curve, corners stay", "left out"}, "Boundary",
                           "What the limit surface does at the boundary of the mesh: follow the B-spline curve of the "
                           "boundary, pass through corners as well, or leave out the outermost faces."));
}

void add_level(RichParameterList& list, int level) {
    list.addParam(RichInt("level", level, "Level", "How often the mesh is refined: each time every polygon becomes as many as "
                                                   "it has corners. 0 moves the vertices only."));
}

void add_options(RichParameterList& list) {
    list.addParam(RichEnum("fit", int(WELT_FIT_SURFACE_SLIDE), QStringList{"none", "loop", "solve", "fit", "fit and slide"}, "Fit",
                           "How the changed mesh is fitted to the surface as it was: not at all; by iteration; by the system "
                           "that the iteration converges to; by least squares over the surface; the same, with vertices that "
                           "may slide along it."));
    list.addParam(RichEnum("parity", int(WELT_PARITY_AUTO), QStringList{"auto", "all quads", "local"}, "Odd faces",
                           "What is done about faces that the marks leave with an odd number of sides: joined by a line where "
                           "the way is short; always; never."));
    list.addParam(RichBool("strict", false, "Strict", "Marks that no rule handles are an error, and not a warning."));
    add_boundary(list);
    list.addParam(RichSaveFile("polygons", "", "OBJ (*.obj)", "Polygon file",
                               "Where to write the new mesh as polygons, in OBJ or PLY. MeshLab's own OBJ has triangles only. "
                               "Empty: nowhere. Choose it with the button: what is typed here MeshLab passes over."));
}

}  // namespace

Filters::Filters() {
    try {
        features_ = array_of(welt::feature_list());
    } catch (std::exception const& error) {
        qWarning("welt: %s", error.what());
    }
}

int Filters::count() const { return features_.size() + HowManyFurther; }

Filters::Kind Filters::kind(int id) const {
    switch (id - features_.size()) {
        case Deviation: return Measures;
        case OpenControlMesh: return Opens;
        default: return Changes;
    }
}

QString Filters::name(int id) const {
    switch (id - features_.size()) {
        case CustomRules: return "Welt: Custom Rules";
        case LimitSurface: return "Welt: Limit Surface";
        case Deviation: return "Welt: Deviation";
        case OpenControlMesh: return "Welt: Open Control Mesh";
    }
    QString const feature = features_[id].toObject()["name"].toString();
    return "Welt: " + feature.left(1).toUpper() + feature.mid(1);
}

QString Filters::info(int id) const {
    static QString const polygons =
        " The layer is a control mesh of a Catmull-Clark surface; quads are pairs of triangles with a faux edge between them, "
        "as MeshLab reads them from PLY and OFF.";
    switch (id - features_.size()) {
        case CustomRules:
            return "Runs a rule file on the marked edges and fits the changed mesh to the surface as it was." + polygons;
        case LimitSurface:
            return "Makes a new layer that is the limit surface: refined, every vertex where it ends up in the limit." + polygons;
        case Deviation:
            return "Makes a new layer that is the limit surface of the current layer and has as quality of its vertices the "
                   "distance to the limit surface of another layer: negative inside of it, positive outside, coloured from red "
                   "to blue." +
                   polygons;
        case OpenControlMesh:
            return "Makes a new layer of a file, OBJ or PLY, whose polygons stay polygons, as the other filters of welt need "
                   "them. MeshLab 2020.09 itself cannot read quads from OBJ.";
    }
    QJsonObject const feature = features_[id].toObject();
    return "<b>" + feature["name"].toString() + "</b>: " + feature["help"].toString() +
           ". It crosses the marked edges; the limit surface stays where it was elsewhere, and the mesh becomes hardly denser." +
           polygons + " Lengths are in the unit of the model, or like 30% of the length of the marked edge.";
}

void Filters::parameters(int id, MeshDocument const& document, RichParameterList& list) const {
    switch (id - features_.size()) {
        case LimitSurface:
            add_level(list, 3);
            add_boundary(list);
            return;
        case Deviation:
            list.addParam(layer_parameter("reference", document, "Reference",
                                          "The layer with the control mesh that the current one is compared with."));
            add_level(list, 2);
            add_boundary(list);
            return;
        case OpenControlMesh:
            list.addParam(RichOpenFile("file", "", QStringList("Control meshes (*.obj *.ply)"), "File",
                                        "The file to open. Choose it with the button: what is typed here MeshLab passes over."));
            return;
        case CustomRules:
            list.addParam(RichOpenFile("rules", "", QStringList("Rules (*.rules)"), "Rule file",
                                        "The rules to run. Choose the file with the button: what is typed here MeshLab passes over."));
            list.addParam(RichString("settings", "", "Settings", "NAME=NUMBER for parameters of the rules, separated by blanks."));
            break;
        default:
            for (QJsonValue const entry : features_[id].toObject()["parameters"].toArray()) {
                QJsonObject const parameter = entry.toObject();
                QString const name = parameter["name"].toString(), help = parameter["help"].toString();
                QString const label = name.left(1).toUpper() + name.mid(1);
                if (parameter["unit"] == "count")
                    list.addParam(RichInt(name, parameter["default"].toInt(), label, help));
                else
                    list.addParam(RichString(name, parameter["default"].toVariant().toString(), label,
                                             help + "; in model units, or like 30% of the length of the marked edge"));
            }
    }
    add_marks(document, list);
    add_options(list);
}

std::string Filters::apply(int id, RichParameterList const& parameters, MeshDocument& document,
                           vcg::CallBackPos* progress) const {
    if (kind(id) != Opens && (!document.mm() || document.mm()->cm.fn == 0))
        throw std::runtime_error("the layer has no faces: choose one that is a control mesh");
    Progress watched(progress);
    try {
        switch (id - features_.size()) {
            case LimitSurface: return make_limit_surface(parameters, document, watched.job());
            case Deviation: return measure_deviation(parameters, document, watched.job());
            case OpenControlMesh: return open_control_mesh(parameters, document);
            case CustomRules: return apply_feature("", {}, parameters, *document.mm(), watched.job());
        }
        QJsonObject const feature = features_[id].toObject();
        return apply_feature(feature["name"].toString(), feature["parameters"].toArray(), parameters, *document.mm(),
                             watched.job());
    } catch (welt::Error const& error) {
        throw explained(error);
    }
}
