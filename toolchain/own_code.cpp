// A plugin for clang-tidy: its checks walk over the declarations of this project only, not over
// those of the system headers that a source includes. clang-tidy does not report what it finds
// there, yet looks for it: that takes four fifths of its time with Eigen and the standard library.
// clangd narrows the scope of clang-tidy in the same way (clang::ASTContext::setTraversalScope).
// The path-sensitive analyzer does not walk this way and is not concerned.
#include <clang/AST/ASTConsumer.h>
#include <clang/AST/ASTContext.h>
#include <clang/AST/Decl.h>
#include <clang/Basic/SourceManager.h>
#include <clang/Frontend/CompilerInstance.h>
#include <clang/Frontend/FrontendAction.h>
#include <clang/Frontend/FrontendPluginRegistry.h>

#include <memory>
#include <string>
#include <vector>

namespace {

class NarrowToOwnCode final : public clang::ASTConsumer {
 public:
  void HandleTranslationUnit(clang::ASTContext& context) override {
    const clang::SourceManager& sources = context.getSourceManager();
    std::vector<clang::Decl*> own;
    for (clang::Decl* declaration : context.getTranslationUnitDecl()->decls()) {
      const clang::SourceLocation place = sources.getExpansionLoc(declaration->getLocation());
      if (place.isValid() && !sources.isInSystemHeader(place)) own.push_back(declaration);
    }
    context.setTraversalScope(own);
  }
};

class OwnCode final : public clang::PluginASTAction {
 protected:
  std::unique_ptr<clang::ASTConsumer> CreateASTConsumer(clang::CompilerInstance& /*compiler*/,
                                                        llvm::StringRef /*source*/) override {
    return std::make_unique<NarrowToOwnCode>();
  }
  bool ParseArgs(const clang::CompilerInstance& /*compiler*/,
                 const std::vector<std::string>& /*arguments*/) override {
    return true;
  }
  ActionType getActionType() override { return AddBeforeMainAction; }  // of clang-tidy
};

const clang::FrontendPluginRegistry::Add<OwnCode> kRegistration(
    "own-code", "walk over the code of this project only");

}  // namespace
