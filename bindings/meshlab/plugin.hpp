// SPDX-License-Identifier: GPL-3.0-or-later
// The plugin class, once for each interface of MeshLab. Both pass everything on to Filters. The first one is what the tests
// run; the second one, for 2021.05 and newer, was tried by hand in PyMeshLab 2022.2, built with the headers of 2022.02.
#pragma once

#include "filter_welt.hpp"

#include <exception>
#include <string>

#ifdef WELT_MESHLAB_2020

class WeltPlugin : public QObject, public MeshFilterInterface {
    Q_OBJECT
    MESHLAB_PLUGIN_IID_EXPORTER(MESH_FILTER_INTERFACE_IID)
    Q_INTERFACES(MeshFilterInterface)

public:
    WeltPlugin() {
        for (int id = 0; id < filters_.count(); ++id) {
            typeList << id;
            actionList << new QAction(filters_.name(id), this);
        }
    }
    QString pluginName() const override { return "FilterWelt"; }
    QString filterName(FilterIDType id) const override { return filters_.name(id); }
    QString filterInfo(FilterIDType id) const override { return filters_.info(id); }
    FilterClass getClass(QAction* action) override {
        static constexpr FilterClass classes[] = {Polygonal, Quality, MeshCreation};
        return classes[filters_.kind(ID(action))];
    }
    int getPreConditions(QAction* action) const override {
        return filters_.kind(ID(action)) == Filters::Opens ? MeshModel::MM_NONE : MeshModel::MM_FACENUMBER;
    }
    int postCondition(QAction*) const override { return MeshModel::MM_GEOMETRY_AND_TOPOLOGY_CHANGE; }
    FILTER_ARITY filterArity(QAction* action) const override {
        static constexpr FILTER_ARITY arities[] = {SINGLE_MESH, FIXED, NONE};
        return arities[filters_.kind(ID(action))];
    }
    void initParameterSet(QAction* action, MeshDocument& document, RichParameterList& list) override {
        filters_.parameters(ID(action), document, list);
    }
    bool applyFilter(QAction* action, MeshDocument& document, RichParameterList const& parameters,
                     vcg::CallBackPos* progress) override {
        try {
            Log(filters_.apply(ID(action), parameters, document, progress));
            return true;
        } catch (std::exception const& error) {
            // meshlabserver shows the log only, the desktop shows both.
            errorMessage = QString::fromUtf8(error.what());
            Log(GLLogStream::WARNING, std::string(error.what()));
            return false;
        }
    }

private:
    Filters filters_;
};

#else

class WeltPlugin : public QObject, public FilterPlugin {
    Q_OBJECT
    MESHLAB_PLUGIN_IID_EXPORTER(FILTER_PLUGIN_IID)
    Q_INTERFACES(FilterPlugin)

public:
    WeltPlugin() {
        for (int id = 0; id < filters_.count(); ++id) {
            typeList.push_back(id);
            actionList.push_back(new QAction(filters_.name(id), this));
        }
    }
    QString pluginName() const override { return "FilterWelt"; }
    QString vendor() const override { return "welt"; }
    QString filterName(ActionIDType id) const override { return filters_.name(id); }
    QString filterInfo(ActionIDType id) const override { return filters_.info(id); }
    FilterClass getClass(QAction const* action) const override {
        static constexpr FilterClass classes[] = {Polygonal, Quality, MeshCreation};
        return classes[filters_.kind(ID(action))];
    }
    int getPreConditions(QAction const* action) const override {
        return filters_.kind(ID(action)) == Filters::Opens ? MeshModel::MM_NONE : MeshModel::MM_FACENUMBER;
    }
    int postCondition(QAction const*) const override { return MeshModel::MM_GEOMETRY_AND_TOPOLOGY_CHANGE; }
    FilterArity filterArity(QAction const* action) const override {
        static constexpr FilterArity arities[] = {SINGLE_MESH, FIXED, NONE};
        return arities[filters_.kind(ID(action))];
    }
    RichParameterList initParameterList(QAction const* action, MeshDocument const& document) override {
        RichParameterList list;
        filters_.parameters(ID(action), document, list);
        return list;
    }
    std::map<std::string, QVariant> applyFilter(QAction const* action, RichParameterList const& parameters,
                                                MeshDocument& document, unsigned int&, vcg::CallBackPos* progress) override {
        try {
            log(filters_.apply(ID(action), parameters, document, progress));
            return {};
        } catch (std::exception const& error) {
            throw MLException(QString::fromUtf8(error.what()));
        }
    }

private:
    Filters filters_;
};

#endif
