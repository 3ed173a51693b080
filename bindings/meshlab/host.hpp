// SPDX-License-Identifier: GPL-3.0-or-later
// The headers of MeshLab, and the calls that differ between MeshLab 2020.09 (WELT_MESHLAB_2020, set by CMake) and the
// interface of 2021.05 and newer.
#pragma once

#ifdef WELT_MESHLAB_2020
#include <common/interfaces.h>
#else
#include <common/plugins/interfaces/filter_plugin.h>
#endif

// A parameter that is a layer of the document.
inline RichMesh layer_parameter(char const* name, MeshDocument const& document, char const* label, char const* help) {
    MeshModel const* current = document.mm();
#ifdef WELT_MESHLAB_2020
    MeshDocument* changeable = const_cast<MeshDocument*>(&document);
    return RichMesh(name, const_cast<MeshModel*>(current), changeable, label, help);
#else
    return RichMesh(name, current ? unsigned(current->id()) : 0, &document, label, help);
#endif
}

// The layer that such a parameter names; NULL where there is none.
inline MeshModel* layer_of(RichParameterList const& parameters, char const* name, MeshDocument& document) {
#ifdef WELT_MESHLAB_2020
    (void)document;
    return parameters.getMesh(name);
#else
    return document.getMesh(parameters.getMeshId(name));
#endif
}
